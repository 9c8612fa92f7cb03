// Distances straight from their definitions, in Real with Eigen: the oracle for the kernels.
// Takes: the float32 numbers of a kernel, with targets before prepare(). Gives: the exact distance
// per row and the bound on the kernel's error; a check of a kernel's result. Keeps true: it is
// compiled without -ffast-math, whatever flags the kernels use, and shares no arithmetic with them.
// No function takes a type of the runtime, because under other flags that is another type.
#pragma once

#include <cfloat>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "etlmon/hosted/error_bounds.hpp"

namespace exact {

/// The widest type with hardware support; except on x86, long double is emulated and slow.
using Real = std::conditional_t<LDBL_MANT_DIG == 64, long double, double>;

struct Case {
    etlmon::MetricId metric = etlmon::MetricId::l2;
    std::uint32_t rows = 0;
    std::uint32_t dimension = 0;
    std::vector<float> z;        ///< dimension
    std::vector<float> targets;  ///< rows x dimension, row-major
    /// Dimension^2 for mahalanobis, dimension for mahalanobis_diagonal.
    std::vector<float> weights;
};

/// Whether the rows are targets, or the one row is a point as z is: then it may be zero, too, and a
/// kernel scales it to length 1 in float32, so the bounds of directions are four times as wide.
enum class Rows : std::uint8_t { targets, point };

struct Aggregate {
    etlmon::AggregationId id = etlmon::AggregationId::min;
    std::uint32_t n = 1;  ///< n of kth, from 1
};

/// The exact distances of a case, computed once for all aggregations.
class Judge {
public:
    Judge(const Case& c, bool flushes_denormals, Rows rows = Rows::targets);
    /// Returns "" if `delta` (as bits, so that no flag affects it) and `nearest` are within the
    /// bounds; otherwise the error.
    std::string mismatch(Aggregate aggregate, std::uint32_t delta_bits,
                         std::uint32_t nearest) const;

private:
    etlmon::MetricId metric_;
    etlmon::Denormals denormals_;
    bool unknown_ = false;
    std::vector<Real> low_, exact_, high_;  ///< one per row
};

/// Returns a symmetric positive definite D x D matrix for the seed.
std::vector<float> positive_definite(std::uint32_t dimension, std::uint32_t seed);

}  // namespace exact
