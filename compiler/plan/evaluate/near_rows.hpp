// Which rows of a target set may be the nearest by mahalanobis with full weights.
// Takes: W and the rows; a point. Gives: the rows that are not left out. Keeps true: a row that is
// left out is farther than another one whatever the kernels round, so the nearest of the others,
// measured by the kernel, has the bits that the nearest of all has. W = L L^T, so the distance is
// l2 between L^T z and L^T g: of D steps a row and not of D^2.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::plan {

class NearRows {
public:
    /// W is positive definite. The target outlives this.
    NearRows(const check::Distance& distance, const check::Target& target);

    /// Rows, ascending. `margin`: how often each distance may be off by what a kernel rounds; at
    /// least 2, since what is computed here is not exact either.
    const std::vector<std::uint32_t>& of(const float* z, double margin);

private:
    void decompose(const std::vector<float>& weights);
    void whiten_rows();
    void measure(const float* z);
    /// How far a row's distance may be off, in double and in a kernel, where |z - g|^2 is at most
    /// `apart`.
    double error(std::uint32_t row, double apart, double margin) const;

    const check::Target& target_;
    std::vector<double> factor_;            ///< L, row-major
    double factor_length_ = 0;              ///< its Frobenius norm
    double spread_ = 0;                     ///< sum over i, j of |d_i| |W_ij| |d_j| <= spread |d|^2
    std::vector<float> whitened_;           ///< L^T g, D x K: a column is a row of the set
    std::vector<double> whitened_lengths_;  ///< |L^T g|
    std::vector<double> lengths_;           ///< |g|
    std::vector<double> point_;             ///< L^T z
    double whitened_length_ = 0;            ///< |L^T z|
    double length_ = 0;                     ///< |z|
    std::vector<float> distances_;          ///< per row; squares at first
    std::vector<double> errors_;            ///< per row: how far its distance may be off
    std::vector<std::uint32_t> near_;
};

}  // namespace etlc::plan
