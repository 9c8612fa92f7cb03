#include "exact.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>

namespace exact {
namespace {

using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using etlmon::AggregationId;
using etlmon::MetricId;

struct Interval {
    Real low, high;
};

Vector vector(const float* x, std::uint32_t n) {
    return Eigen::Map<const Eigen::VectorXf>(x, n).cast<Real>();
}

/// Returns the weights as D x D, or as one column for a diagonal.
Matrix weights_of(const Case& c) {
    const auto d = static_cast<Eigen::Index>(c.dimension);
    if (c.metric == MetricId::mahalanobis_diagonal) return vector(c.weights.data(), c.dimension);
    if (c.metric != MetricId::mahalanobis) return {};
    using Given = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const Given>(c.weights.data(), d, d).cast<Real>();
}

Real distance(MetricId metric, const Vector& z, const Vector& g, const Matrix& w) {
    const Vector d = z - g;
    switch (metric) {
        case MetricId::l2: return d.norm();
        case MetricId::l2sq: return d.squaredNorm();
        case MetricId::l1: return d.lpNorm<1>();
        case MetricId::linf: return d.lpNorm<Eigen::Infinity>();
        case MetricId::cosine: return (z.normalized() - g.normalized()).squaredNorm() / 2;
        case MetricId::angular:
            return 2 * std::atan2((z.normalized() - g.normalized()).norm(),
                                  (z.normalized() + g.normalized()).norm());
        case MetricId::mahalanobis: return std::sqrt(std::max<Real>(0, d.dot(w * d)));
        case MetricId::mahalanobis_diagonal: return std::sqrt(d.cwiseAbs2().dot(w.col(0)));
    }
    return 0;
}

Real aggregated(std::vector<Real> values, Aggregate aggregate) {
    if (aggregate.id == AggregationId::mean) {
        Real sum = 0;
        for (const Real v : values) sum += v;
        return sum / static_cast<Real>(values.size());
    }
    std::sort(values.begin(), values.end());
    switch (aggregate.id) {
        case AggregationId::min: return values.front();
        case AggregationId::max: return values.back();
        default: return values[aggregate.n - 1];
    }
}

std::string report(Real got, Interval want) {
    std::ostringstream text;
    text.precision(20);
    text << "computed " << got << ", must lie in [" << want.low << ", " << want.high << "]";
    return text.str();
}

}  // namespace

Judge::Judge(const Case& c, bool flushes_denormals, Rows rows)
    : metric_(c.metric),
      denormals_(flushes_denormals ? etlmon::Denormals::flushed : etlmon::Denormals::kept) {
    const auto is_zero = [&](float x) {
        return flushes_denormals ? std::fabs(x) < FLT_MIN : x == 0;
    };
    const auto is_zero_vector = [&](const std::vector<float>& v) {
        return std::all_of(v.begin(), v.end(), is_zero);
    };
    const bool of_directions = etlmon::distance(c.metric).zero_is_unknown;
    unknown_ = of_directions &&
               (is_zero_vector(c.z) || (rows == Rows::point && is_zero_vector(c.targets)));
    const double times = of_directions && rows == Rows::point ? 4 : 1;
    const Vector z = vector(c.z.data(), c.dimension);
    const Matrix w = weights_of(c);
    for (std::uint32_t row = 0; row < c.rows && !unknown_; ++row) {
        const Vector g = vector(c.targets.data() + std::size_t{row} * c.dimension, c.dimension);
        const Real d = distance(c.metric, z, g, w);
        const Vector size = (z - g).cwiseAbs();
        const Real magnitude =
            c.metric == MetricId::mahalanobis ? size.dot(w.cwiseAbs() * size) : 0;
        const Real bound =
            times * etlmon::rounding_bound(c.metric, c.dimension, static_cast<double>(d),
                                           static_cast<double>(magnitude), denormals_);
        low_.push_back(std::max<Real>(0, d - bound));
        exact_.push_back(d);
        high_.push_back(d + bound);
    }
}

std::string Judge::mismatch(Aggregate aggregate, std::uint32_t delta_bits,
                            std::uint32_t nearest) const {
    float delta = 0;
    std::memcpy(&delta, &delta_bits, sizeof delta);
    if (unknown_) {
        return std::isnan(delta) && nearest == 0
                   ? ""
                   : "a zero vector has no distance, got " + std::to_string(delta);
    }
    if (std::isnan(delta)) return "NaN";
    if (nearest >= exact_.size()) return "nearest row " + std::to_string(nearest);
    if (delta < 0 || delta > etlmon::distance(metric_).highest)
        return "out of range: " + std::to_string(delta);

    Interval want{aggregated(low_, aggregate), aggregated(high_, aggregate)};
    if (aggregate.id == AggregationId::mean) {
        const auto mean = static_cast<double>(aggregated(exact_, aggregate));
        const Real more =
            etlmon::mean_bound(static_cast<std::uint32_t>(exact_.size()), mean, denormals_);
        want = {want.low - more, want.high + more};
    }
    // The kernels treat distances beyond FLT_MAX as equal; they make a mean infinite.
    const Real most = FLT_MAX;
    const Real highest = *std::max_element(high_.begin(), high_.end());
    const bool overflows = (aggregate.id == AggregationId::mean ? highest : want.high) > most;
    if (std::min(low_[nearest], most) > *std::min_element(high_.begin(), high_.end())) {
        return "row " + std::to_string(nearest) +
               " is not the nearest: " + report(low_[nearest], want);
    }
    if (std::isinf(delta)) return overflows ? "" : report(delta, want);
    return want.low <= delta && delta <= want.high ? "" : report(delta, want);
}

std::vector<float> positive_definite(std::uint32_t dimension, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    const auto d = static_cast<Eigen::Index>(dimension);
    using Given = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Given factor =
        Given::NullaryExpr(d, std::min<Eigen::Index>(d, 8), [&] { return normal(random); });
    Given w = factor * factor.transpose() / 8 + Given::Identity(d, d) * 0.5F;
    w = ((w + w.transpose()) / 2).eval();
    return {w.data(), w.data() + w.size()};
}

}  // namespace exact
