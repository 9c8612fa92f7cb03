#include "execute/tables.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>

#include "etlmon/hosted/error_bounds.hpp"
#include "plan/program/reading.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"

namespace etlc::execute {

using namespace plan;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The largest sum in a kernel; larger ones may overflow.
constexpr double kGreatest = static_cast<double>(FLT_MAX) / 4;

/// Returns a bound of the norm of |W|, the matrix of absolute values: its greatest row sum, or its
/// Frobenius norm.
double spread_of(const std::vector<float>& weights, std::size_t n) {
    double greatest = 0;
    double squares = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
            const auto w = static_cast<double>(weights[i * n + j]);
            sum += std::abs(w);
            squares += w * w;
        }
        greatest = std::max(greatest, sum);
    }
    return std::min(greatest, std::sqrt(squares));
}

template <class Number>
double length(const Number* v, std::size_t n) {
    double squares = 0;
    for (std::size_t i = 0; i < n; ++i)
        squares += static_cast<double>(v[i]) * static_cast<double>(v[i]);
    return std::sqrt(squares);
}

double squared_distance(const float* z, const float* g, std::size_t n) {
    double squares = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double apart = static_cast<double>(z[i]) - static_cast<double>(g[i]);
        squares += apart * apart;
    }
    return squares;
}

/// Adds factor x from[j] to to[j].
void add_multiple(const double* __restrict from, double factor, double* __restrict to,
                  std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) to[j] += factor * from[j];
}

/// Adds (x - from[j])^2 to to[j], for several j at a time: row by row every addition would wait for
/// the one before.
void add_squares(const float* __restrict from, float x, float* __restrict to, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) to[j] += (x - from[j]) * (x - from[j]);
}

}  // namespace

NearRows::NearRows(const check::Distance& distance, const check::Target& target)
    : target_(target),
      whitened_(target.values.size()),
      point_(target.dimension),
      distances_(target.rows),
      errors_(target.rows),
      near_(target.rows) {
    if (target.rows == 1) return;  // there is nothing to choose
    spread_ = spread_of(distance.weights, target.dimension);
    decompose(distance.weights);
    whiten_rows();
}

/// Computes the Cholesky factor row by row.
void NearRows::decompose(const std::vector<float>& weights) {
    const std::size_t n = target_.dimension;
    factor_.resize(n * n);
    for (std::size_t i = 0; i < n; ++i) {
        double* row = &factor_[i * n];
        for (std::size_t j = 0; j <= i; ++j) {
            const double* other = &factor_[j * n];
            const double rest = static_cast<double>(weights[i * n + j]) -
                                std::inner_product(row, row + j, other, 0.0);
            row[j] = i == j ? std::sqrt(rest) : rest / other[j];
        }
    }
    factor_length_ = length(factor_.data(), factor_.size());
}

void NearRows::whiten_rows() {
    const std::size_t n = target_.dimension;
    std::vector<double> whitened(n);
    for (std::size_t k = 0; k < target_.rows; ++k) {
        const float* g = &target_.values[k * n];
        std::fill(whitened.begin(), whitened.end(), 0);
        for (std::size_t i = 0; i < n; ++i)
            add_multiple(&factor_[i * n], static_cast<double>(g[i]), whitened.data(), i + 1);
        for (std::size_t i = 0; i < n; ++i)
            whitened_[i * target_.rows + k] = static_cast<float>(whitened[i]);
        whitened_lengths_.push_back(length(whitened.data(), n));
        lengths_.push_back(length(g, n));
    }
}

void NearRows::measure(const float* z) {
    const std::size_t n = target_.dimension;
    const std::size_t rows = target_.rows;
    std::fill(point_.begin(), point_.end(), 0);
    std::fill(distances_.begin(), distances_.end(), 0);
    for (std::size_t i = 0; i < n; ++i)
        add_multiple(&factor_[i * n], static_cast<double>(z[i]), point_.data(), i + 1);
    for (std::size_t i = 0; i < n; ++i)
        add_squares(&whitened_[i * rows], static_cast<float>(point_[i]), distances_.data(), rows);
    for (float& distance : distances_) distance = std::sqrt(distance);
    whitened_length_ = length(point_.data(), n);
    length_ = length(z, n);
}

double NearRows::error(std::uint32_t row, double apart, double margin) const {
    const double n = target_.dimension;
    const double magnitude = spread_ * apart;
    if (magnitude > kGreatest) return kInfinity;
    const auto distance = static_cast<double>(distances_[row]);
    // L^T z and L^T g in double: D roundings of each element's terms. Then in float32: their
    // difference, D squares and their sum, which loses denormal ones.
    const double in_double = 2 * (n + 8) * DBL_EPSILON * factor_length_ * (length_ + lengths_[row]);
    const double as_float = FLT_EPSILON * (whitened_length_ + whitened_lengths_[row]) +
                            (n + 8) * FLT_EPSILON * distance + std::sqrt(n * FLT_MIN);
    return in_double + as_float +
           margin * etlmon::rounding_bound(etlmon::MetricId::mahalanobis, target_.dimension,
                                           distance, magnitude);
}

/// Selects rows first by a free bound of |z - g|, then by the distance itself.
const std::vector<std::uint32_t>& NearRows::of(const float* z, double margin) {
    if (target_.rows == 1) return near_;
    measure(z);
    near_.resize(target_.rows);
    std::iota(near_.begin(), near_.end(), 0);
    const auto keep_near = [&](const auto& apart) {
        double least = kInfinity;
        for (const std::uint32_t k : near_) {
            errors_[k] = error(k, apart(k), margin);
            least = std::min(least, static_cast<double>(distances_[k]) + errors_[k]);
        }
        // NaN stays.
        std::erase_if(near_, [&](std::uint32_t k) {
            return static_cast<double>(distances_[k]) - errors_[k] > least;
        });
    };
    keep_near([&](std::uint32_t k) { return std::pow(length_ + lengths_[k], 2); });
    keep_near([&](std::uint32_t k) {
        const float* g = &target_.values[std::size_t{k} * target_.dimension];
        return squared_distance(z, g, target_.dimension);
    });
    return near_;
}

namespace {

/// Finds what a point of `ago` steps before rests on, and how long ago. Calibration also needs what
/// a delayed point was projected from.
void keep_for(const check::Model& model, Index index, std::uint32_t ago,
              std::map<Index, std::uint32_t>& longest) {
    const check::Point& point = model.points[index];
    if (!point.is_delayed() && ago > 0) longest[index] = std::max(longest[index], ago);
    if (point.inner != kNone) keep_for(model, point.inner, ago + point.steps, longest);
    for (const Index part : point.parts) keep_for(model, part, ago, longest);
}

}  // namespace

Tables::Tables(const Plan& plan) {
    const check::Model& model = *plan.model;
    for (const Stream& stream : plan.streams)
        if (stream.op == StreamOp::flag) flags.push_back(stream.index);
    measured_points = points_of(model, plan.distances);
    take_shape(plan);
    for (const Index p : measured_points)
        if (model.points[p].is_projected())
            centred = std::max<std::size_t>(
                centred, model.projections[model.points[p].projection].dimension);
    prepared.resize(model.distances.size());
    widened.resize(model.distances.size());
    narrow.resize(model.distances.size());
    for (const Index d : plan.distances) prepare(plan, d);
    for (const check::Predicate& predicate : model.predicates)
        contrast_cuts.push_back(plan::contrast_cuts(plan, predicate));
}

void Tables::take_shape(const Plan& plan) {
    std::map<Index, std::uint32_t> longest;
    for (const Index p : measured_points) keep_for(*plan.model, p, 0, longest);
    for (const auto& [point, steps] : longest) shape.kept.push_back({point, steps + 1});
    for (const Stream& stream : plan.streams) shape.streams.push_back(members_of(stream));
    for (const Reading& reading : plan.readings) {
        std::vector<Value>& first = shape.registers.emplace_back();
        if (reading.kind == Reading::Kind::pending || reading.kind == Reading::Kind::table)
            continue;
        for (const Member& member : members_of(reading)) first.push_back(member.first);
    }
}

void Tables::prepare(const Plan& plan, Index d) {
    const check::Model& model = *plan.model;
    const check::Distance& distance = model.distances[d];
    scratch = std::max<std::size_t>(scratch, distance.kth);
    if (distance.is_between_points()) {
        scratch = std::max<std::size_t>(scratch, model.dimension_of(d));
        return;
    }
    prepared[d] = prepared_rows(model, distance);
    if (distance.full_weights() && distance.aggregation == check::Aggregation::min) {
        near.try_emplace(d, distance, model.targets[distance.target]);
        near_values = std::max(near_values, prepared[d].size());
    }
    narrow[d] = narrow_set(plan, d);
    if (narrow[d] != nullptr) widened[d] = widened_rows(*narrow[d]);
}

}  // namespace etlc::execute
