#include "calibrate/bounds.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/numbers/decimal.hpp"
#include "check/numbers/range.hpp"
#include "episodes/truth.hpp"
#include "etlmon/hosted/error_bounds.hpp"
#include "etlmon/temporal/expression.hpp"
#include "plan/targets/kernels.hpp"

namespace etlc::calibrate {

namespace {

using check::Aggregation;
using check::Distance;
using check::Expr;
using check::Range;
using check::round_down;
using check::round_up;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Covers the rounding of this file's own arithmetic in double.
constexpr double kSlack = 1 + 1e-12;

/// Bounds |computed - exact| for a row, or for a mean over `rows` rows, at the distance `exact`.
/// The bound is concave in `exact`, so a bound for rows also holds for their mean.
double error(const Distance& distance, std::uint32_t rows, std::uint32_t dimension, double exact,
             double magnitude) {
    double bound = etlmon::rounding_bound(plan::metric_id(distance), dimension, exact, magnitude);
    if (distance.is_between_points() && check::is_of_directions(distance.metric))
        bound *= 4;  // see etlmon/distance/between.hpp
    if (distance.aggregation == Aggregation::mean) bound += etlmon::mean_bound(rows, exact + bound);
    return bound * kSlack;
}

/// Bounds the change of a distance whose point moves by `moved` in the distance's norm (cosine and
/// angular: at length 1), see etlmon/distance/enclosed.hpp. Concave in the distance.
double change(const Distance& distance, double exact, double moved) {
    switch (distance.metric) {
        case check::Metric::l2sq: return moved * (2 * std::sqrt(exact) + moved);
        case check::Metric::cosine: return moved * (std::sqrt(2 * exact) + moved / 2);
        case check::Metric::angular: return moved <= 0.25 ? 1.6 * moved : 4.0;
        case check::Metric::l2:
        case check::Metric::l1:
        case check::Metric::linf:
        case check::Metric::mahalanobis: break;
    }
    return moved;
}

/// Returns the interval of distances that any build may measure. Two builds differ by at most twice
/// the error of one. The greatest exact distance that measures as `delta` solves
/// exact = delta + error(exact); the iteration converges to it from below, because the error grows
/// slower than exact. `moved` is the distance between the points that two builds measure from.
Interval spread(const Distance& distance, std::uint32_t rows, std::uint32_t dimension, double delta,
                double magnitude, double moved) {
    if (std::isinf(delta)) return {delta, delta};
    const auto error_at = [&](double exact) {
        return error(distance, rows, dimension, exact, magnitude);
    };
    double greatest = delta;
    for (int i = 0; i < 100; ++i) {
        const double next = delta + error_at(greatest);
        const bool settled = next <= greatest * (1 + 1e-15);
        greatest = std::max(greatest, next);
        if (settled) break;
    }
    greatest = greatest * kSlack + DBL_MIN;
    // With full weights the error is r^2 / exact above some r, so it first falls as `exact` grows.
    // For delta above 2 r the exact distance is at least delta / 2; for smaller ones the lower
    // bound is not positive.
    double below = error_at(delta) + (magnitude > 0 ? error_at(delta / 2) : 0);
    if (moved > 0) {
        const double changed = change(distance, greatest, moved) * kSlack;
        // the falling part of the error is greatest at zero
        below += changed / 2 + (magnitude > 0 ? error_at(0) : 0);
        greatest += changed;
    }
    const bool cut_off =
        distance.metric == check::Metric::cosine && distance.aggregation != Aggregation::mean;
    const double ceiling = cut_off ? 2.0 : kInfinity;
    return {std::max(0.0, delta - 2 * below), std::min(ceiling, greatest + error_at(greatest))};
}

/// Returns the elements that a point had so many steps before.
const float* elements_of(const check::Model& model, Index index, std::uint32_t ago,
                         const execute::Evaluator& measured) {
    const check::Point& point = model.points[index];
    return point.is_delayed() ? elements_of(model, point.inner, ago + point.steps, measured)
                              : measured.point(index, ago);
}

/// Bounds |a - b| for each element of a point, of which two builds compute a and b; empty for
/// points that are not computed.
std::vector<double> moves_of(const check::Model& model, Index index, std::uint32_t ago,
                             const execute::Evaluator& measured);

/// Bounds them for points put together.
std::vector<double> joined_moves(const check::Model& model, const check::Point& point,
                                 std::uint32_t ago, const execute::Evaluator& measured) {
    std::vector<double> all;
    bool computed = false;
    for (const Index part : point.parts) {
        std::vector<double> moves = moves_of(model, part, ago, measured);
        computed = computed || !moves.empty();
        moves.resize(model.points[part].dimension);
        all.insert(all.end(), moves.begin(), moves.end());
    }
    return computed ? all : std::vector<double>{};
}

/// Bounds them for a sum, a projection by its factors. Builds add equal points to equal sums, but
/// for denormals.
std::vector<double> sum_moves(const check::Model& model, const check::Point& point,
                              std::uint32_t ago, const execute::Evaluator& measured) {
    std::vector<double> magnitude(point.dimension);
    std::vector<double> size(point.dimension);
    std::vector<double> moves(point.dimension);
    bool computed = false;
    for (std::size_t i = 0; i < point.parts.size(); ++i) {
        const double factor = std::abs(static_cast<double>(point.factors[i]));
        std::vector<double> inner = moves_of(model, point.parts[i], ago, measured);
        computed = computed || !inner.empty();
        inner.resize(point.dimension);
        const float* const z = elements_of(model, point.parts[i], ago, measured);
        for (std::size_t j = 0; j < point.dimension; ++j) {
            const double greatest = std::abs(static_cast<double>(z[j])) + inner[j];
            magnitude[j] += factor * greatest;
            size[j] += factor + greatest;
            moves[j] += factor * inner[j];
        }
    }
    const auto terms = static_cast<std::uint32_t>(point.parts.size());
    for (std::size_t j = 0; j < point.dimension; ++j)
        moves[j] += 2 * etlmon::projection_bound(terms, computed ? magnitude[j] : 0, size[j]);
    for (double& move : moves) move *= kSlack;
    return moves;
}

/// `ago`: of the point as it was so many steps before.
std::vector<double> moves_of(const check::Model& model, Index index, std::uint32_t ago,
                             const execute::Evaluator& measured) {
    const check::Point& point = model.points[index];
    if (point.is_delayed()) return moves_of(model, point.inner, ago + point.steps, measured);
    if (point.is_joined()) return joined_moves(model, point, ago, measured);
    if (point.is_sum()) return sum_moves(model, point, ago, measured);
    if (!point.is_projected()) return {};
    const check::Projection& map = model.projections[point.projection];
    const std::vector<double> inner = moves_of(model, point.inner, ago, measured);
    const float* const z = elements_of(model, point.inner, ago, measured);
    std::vector<double> moves;
    for (std::size_t i = 0; i < map.rows; ++i) {
        double magnitude = 0;
        double size = 0;
        double carried = 0;
        for (std::size_t j = 0; j < map.dimension; ++j) {
            const double a = std::abs(static_cast<double>(map.matrix[i * map.dimension + j]));
            const double moved = inner.empty() ? 0 : inner[j];
            const double offset = map.offset.empty() ? 0 : static_cast<double>(map.offset[j]);
            const double difference = std::abs(static_cast<double>(z[j]) - offset) + moved;
            magnitude += a * difference;
            size += a + difference;
            carried += a * moved;
        }
        moves.push_back((carried + 2 * etlmon::projection_bound(map.dimension, magnitude, size)) *
                        kSlack);
    }
    return moves;
}

/// Returns the norm of the moves, in the norm of the distance (cosine and angular: at length 1).
double norm_of(const Distance& distance, const std::vector<double>& moves, const float* z) {
    const std::size_t n = moves.size();
    double sum = 0;
    double squares = 0;
    double greatest = 0;
    double length = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double e = moves[i];
        sum += e;
        greatest = std::max(greatest, e);
        length += static_cast<double>(z[i]) * static_cast<double>(z[i]);
        if (distance.weights.empty() || distance.weights_diagonal) {
            squares += e * e * (distance.weights.empty() ? 1.0 : distance.weights[i]);
            continue;
        }
        for (std::size_t j = 0; j < n; ++j)
            squares += e * std::abs(static_cast<double>(distance.weights[i * n + j])) * moves[j];
    }
    if (n == 0) return 0;
    switch (distance.metric) {
        case check::Metric::l1: return sum * kSlack;
        case check::Metric::linf: return greatest * kSlack;
        case check::Metric::cosine:  // |u/|u| - v/|v|| is at most 2 |u - v| / |u|
        case check::Metric::angular: return 2 * std::sqrt(squares / length) * kSlack;
        case check::Metric::l2:
        case check::Metric::l2sq:
        case check::Metric::mahalanobis: break;
    }
    return std::sqrt(squares) * kSlack;
}

/// An upper bound of the sum over i, j of |d_i| |W_ij| |d_j|, d = z - g, with each |d_i| enlarged
/// by `moves` (see etlmon/hosted/error_bounds.hpp). It is the square of a distance with weights
/// |W|. The terms are not negative, so a kernel's error is rounding alone.
class Magnitude {
public:
    explicit Magnitude(const Distance& distance) : absolute_(distance) {
        absolute_.aggregation = Aggregation::min;
        for (float& weight : absolute_.weights) weight = std::abs(weight);
    }

    double of(const float* z, const float* g, std::uint32_t dimension,
              const std::vector<double>& moves) {
        apart_.resize(dimension);
        origin_.resize(dimension);
        for (std::uint32_t i = 0; i < dimension; ++i)
            apart_[i] = round_up(std::abs(static_cast<double>(z[i]) - static_cast<double>(g[i])) +
                                 (moves.empty() ? 0 : moves[i]));
        const auto measured = static_cast<double>(
            plan::measure(absolute_, apart_.data(), origin_.data(), 1, dimension, nullptr).delta);
        const double roundings = (dimension + 16.0) * static_cast<double>(FLT_EPSILON);
        const double lost = dimension * static_cast<double>(FLT_MIN);
        const double root = (measured + lost) * (1 + 2 * roundings);
        return root * root;
    }

private:
    Distance absolute_;
    std::vector<float> apart_;
    std::vector<float> origin_;
};

/// Combines the intervals of the `rows`, each of which has its own error: aggregates are monotonic
/// in every row, and a minimum does not depend on the rows left out.
Interval of_full_weights(const Distance& distance, const check::Target& target, const float* z,
                         const std::vector<std::uint32_t>& rows, const std::vector<double>& moves) {
    Distance row = distance;
    row.aggregation = Aggregation::min;
    const double moved = norm_of(distance, moves, z);
    Magnitude magnitude(distance);
    std::vector<double> lows;
    std::vector<double> highs;
    for (const std::uint32_t k : rows) {
        const float* g = target.values.data() + static_cast<std::size_t>(k) * target.dimension;
        const float delta = plan::measure(row, z, g, 1, target.dimension, nullptr).delta;
        const Interval one = spread(row, 1, target.dimension, static_cast<double>(delta),
                                    magnitude.of(z, g, target.dimension, moves), moved);
        lows.push_back(one.low);
        highs.push_back(one.high);
    }
    Interval result{episodes::aggregate(distance, lows), episodes::aggregate(distance, highs)};
    if (distance.aggregation != Aggregation::mean) return result;
    result.low = std::max(0.0, result.low - etlmon::mean_bound(target.rows, result.high));
    result.high += etlmon::mean_bound(target.rows, result.high);
    return result;
}

/// Returns the rows that may be the nearest in some build that measures from the same point. An end
/// of a row's interval is off by at most six times a kernel's rounding, see spread().
std::vector<std::uint32_t> rows_that_count(const Distance& distance, const check::Target& target,
                                           Index index, const std::vector<double>& moves,
                                           const execute::Evaluator& measured) {
    if (distance.aggregation == Aggregation::min && moves.empty())
        return measured.near_rows(index, measured.point(distance.point), 16);
    std::vector<std::uint32_t> all(target.rows);
    std::iota(all.begin(), all.end(), 0);
    return all;
}

/// Bounds the distance between two points, both of which a build may compute.
Interval between_points(const check::Model& model, Index index,
                        const execute::Evaluator& measured) {
    const Distance& distance = model.distances[index];
    const std::uint32_t dimension = model.dimension_of(index);
    const auto delta = static_cast<double>(measured.measured(index).delta);
    if (std::isinf(delta)) return spread(distance, 1, dimension, delta, 0, 0);
    const float* const z = measured.point(distance.point);
    const float* const g = measured.point(distance.other);
    std::vector<double> moves = moves_of(model, distance.point, 0, measured);
    const std::vector<double> others = moves_of(model, distance.other, 0, measured);
    const double moved = norm_of(distance, moves, z) + norm_of(distance, others, g);
    if (!distance.full_weights()) return spread(distance, 1, dimension, delta, 0, moved);
    moves.resize(dimension);
    for (std::size_t i = 0; i < others.size(); ++i) moves[i] += others[i];
    return spread(distance, 1, dimension, delta, Magnitude(distance).of(z, g, dimension, moves),
                  moved);
}

Interval of_distance(const check::Model& model, Index index, const execute::Evaluator& measured) {
    const Distance& distance = model.distances[index];
    if (distance.is_between_points()) return between_points(model, index, measured);
    const check::Target& target = model.targets[distance.target];
    const float delta = measured.measured(index).delta;
    const float* const z = measured.point(distance.point);
    if (std::isinf(delta))
        return spread(distance, target.rows, target.dimension, static_cast<double>(delta), 0, 0);
    const std::vector<double> moves = moves_of(model, distance.point, 0, measured);
    if (distance.full_weights())
        return of_full_weights(distance, target, z,
                               rows_that_count(distance, target, index, moves, measured), moves);
    return spread(distance, target.rows, target.dimension, static_cast<double>(delta), 0,
                  norm_of(distance, moves, z));
}

/// Evaluates an expression over intervals. Exact operands give an exact result, unless a build may
/// flush it to zero.
class Expression {
public:
    Expression(const check::Model& model, const execute::Evaluator& measured,
               const PastIntervals& pasts)
        : model_(model), measured_(measured), pasts_(pasts) {}

    Range of(const Expr& e) const {
        if (e.kind == Expr::Kind::past) return flushed(pasts_[e.index]);
        std::vector<Range> a;
        for (const Expr& argument : e.arguments) a.push_back(of(argument));
        const bool exact =
            std::all_of(a.begin(), a.end(), [](const Range& r) { return r.low == r.high; });
        const auto binary = [&](auto on_numbers, auto on_ranges) {
            if (exact) return flushed(on_numbers(a[0].low, a[1].low));
            return widened(on_ranges(a[0], a[1]));
        };
        switch (e.kind) {
            case Expr::Kind::number: return flushed(e.number32);
            case Expr::Kind::scalar: return flushed(*measured_.input(e.index));
            case Expr::Kind::distance: return distance(e.index);
            case Expr::Kind::past: break;
            case Expr::Kind::negate: return check::negate(a[0]);
            case Expr::Kind::add:
                return binary([](float x, float y) { return etlmon::add(x, y); }, check::add);
            case Expr::Kind::subtract:
                return binary([](float x, float y) { return etlmon::subtract(x, y); },
                              check::subtract);
            case Expr::Kind::multiply:
                return binary([](float x, float y) { return etlmon::multiply(x, y); },
                              check::multiply);
            case Expr::Kind::divide:
                return binary([](float x, float y) { return etlmon::divide(x, y); }, check::divide);
            case Expr::Kind::abs: return check::abs(a[0]);
            case Expr::Kind::sqrt:
                return widened(check::sqrt(a[0]));  // may differ in the last place
            case Expr::Kind::min: return check::min(a);
            case Expr::Kind::max: return check::max(a);
        }
        return {};
    }

private:
    static Range flushed(float x) {
        if (!(std::abs(x) < FLT_MIN)) return {x, x};
        return {std::min(x, 0.0F), std::max(x, 0.0F)};
    }

    static Range flushed(const Range& r) { return {flushed(r.low).low, flushed(r.high).high}; }

    static Range widened(const Range& r) {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        return {round_down(static_cast<double>(std::nextafter(r.low, -kEnd)) -
                           static_cast<double>(FLT_MIN)),
                round_up(static_cast<double>(std::nextafter(r.high, kEnd)) +
                         static_cast<double>(FLT_MIN))};
    }

    Range distance(Index index) const {
        const Interval interval = of_distance(model_, index, measured_);
        return {round_down(interval.low), round_up(interval.high)};
    }

    const check::Model& model_;
    const execute::Evaluator& measured_;
    const PastIntervals& pasts_;
};

/// Returns the range of an expression that this build knows.
Range known(const Expression& evaluated, const Expr& expression) {
    const Range range = evaluated.of(expression);
    return range.low <= range.high ? range : check::kEverything;  // infinities that cancel
}

}  // namespace

PastIntervals::PastIntervals(const check::Model& model, const plan::Plan& plan)
    : model_(model), pasts_(plan.pasts), now_(model.pasts.size()) {
    for (const Index past : pasts_) {
        lows_.emplace_back(model.pasts[past]);
        highs_.emplace_back(model.pasts[past]);
    }
}

void PastIntervals::reset() {
    for (execute::PastState& low : lows_) low.reset();
    for (execute::PastState& high : highs_) high.reset();
}

void PastIntervals::step(const execute::Evaluator& measured) {
    for (std::size_t i = 0; i < pasts_.size(); ++i) {
        const Index past = pasts_[i];
        Range operand{etlmon::kMissing, etlmon::kMissing};
        if (!std::isnan(measured.operand_of(past)))
            operand = known(Expression(model_, measured, *this), model_.pasts[past].expression);
        const float low = lows_[i].push(operand.low), high = highs_[i].push(operand.high);
        // A mean of infinities of both signs has no value.
        now_[past] = {std::isnan(low) ? check::kEverything.low : low,
                      std::isnan(high) ? check::kEverything.high : high};
    }
}

Interval interval_of(const Distance& distance, std::uint32_t rows, std::uint32_t dimension,
                     double delta) {
    return spread(distance, rows, dimension, delta, 0, 0);
}

std::optional<Interval> interval_of(const check::Model& model, Index predicate,
                                    const execute::Evaluator& measured,
                                    const PastIntervals& pasts) {
    const check::Predicate& p = model.predicates[predicate];
    if (std::isnan(measured.distance(predicate))) return std::nullopt;
    if (p.plain_distance()) return of_distance(model, p.expression.index, measured);
    const Range range = known(Expression(model, measured, pasts), p.expression);
    return Interval{static_cast<double>(range.low), static_cast<double>(range.high)};
}

}  // namespace etlc::calibrate
