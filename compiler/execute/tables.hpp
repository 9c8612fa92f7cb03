// What an evaluator computes once from a plan: rows as kernels read them. It does not change, so
// evaluators of the same plan share it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "check/model/model.hpp"
#include "execute/state.hpp"
#include "plan/program/program.hpp"

namespace etlc::execute {

// Finds the rows of a target set that may be nearest by mahalanobis with full weights. W = L L^T,
// so the distance is l2 between L^T z and L^T g, which takes D steps a row instead of D^2. A row
// that is left out is farther than another one whatever the kernels round, so the nearest of the
// remaining rows, measured by the kernel, has the same bits as the nearest of all.

class NearRows {
public:
    /// W has to be positive definite. The target outlives this.
    NearRows(const check::Distance& distance, const check::Target& target);

    /// Returns rows, ascending. `margin`: how many times the rounding of a kernel each distance may
    /// be off; at least 2, since this computation rounds too.
    const std::vector<std::uint32_t>& of(const float* z, double margin);

private:
    void decompose(const std::vector<float>& weights);
    void whiten_rows();
    void measure(const float* z);
    /// Returns how far a row's distance may be off, in double and in a kernel, where |z - g|^2 is
    /// at most `apart`.
    double error(std::uint32_t row, double apart, double margin) const;

    const check::Target& target_;
    std::vector<double> factor_;            ///< L, row-major
    double factor_length_ = 0;              ///< Frobenius norm of L
    double spread_ = 0;                     ///< sum over i, j of |d_i| |W_ij| |d_j| <= spread |d|^2
    std::vector<float> whitened_;           ///< L^T g, D x K: a column is a row of the set
    std::vector<double> whitened_lengths_;  ///< |L^T g|
    std::vector<double> lengths_;           ///< |g|
    std::vector<double> point_;             ///< L^T z
    double whitened_length_ = 0;            ///< |L^T z|
    double length_ = 0;                     ///< |z|
    std::vector<float> distances_;          ///< per row; squares at first
    std::vector<double> errors_;            ///< per row: bound of the error
    std::vector<std::uint32_t> near_;
};

struct Tables {
    /// The plan outlives it.
    explicit Tables(const plan::Plan& plan);

    std::vector<check::Index> flags;             ///< bools of the model that formulas read
    std::vector<check::Index> measured_points;   ///< points of the model, each after its inner one
    Shape shape;                                 ///< of a state
    std::vector<std::vector<float>> prepared;    ///< per distance: prepared rows
    std::vector<std::vector<float>> widened;     ///< per distance: its narrow rows, widened
    std::vector<const plan::NarrowSet*> narrow;  ///< per distance: its narrow rows; null: none
    /// For distances by full weights to the nearest row: how to find candidates.
    std::map<check::Index, NearRows> near;
    /// Per predicate: where its difference changes the comparison, for narrow targets.
    std::vector<std::vector<plan::Cut>> contrast_cuts;
    std::size_t near_values = 0;  ///< most floats of candidate rows
    std::size_t scratch = 0;      ///< floats that kernels need
    std::size_t centred = 0;      ///< floats that projections need

private:
    void take_shape(const plan::Plan& plan);
    void prepare(const plan::Plan& plan, check::Index distance);
};

}  // namespace etlc::execute
