// The typed spec: names resolved, numbers rounded, data loaded, everything checked.
// Takes its form from check/check.cpp. Gives: reference/, ir/, calibrate/ and evaluate/ all they
// need; none of them sees the AST. Keeps true: every index is in range; every formula is
// well-typed; a Formula's operands have smaller indices than itself (the formulas are a DAG in
// topological order, a `let` is the node it names, not a copy).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ast/operators.hpp"
#include "check/model/inputs.hpp"
#include "check/numbers/bounds.hpp"
#include "source/source.hpp"

namespace etlc::check {

// ---- what is measured ---------------------------------------------------------------------------

enum class Metric : std::uint8_t {
#define DISTANCE(id, Type, prepared, zero_is_unknown) id,
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
};

/// The words of the metrics, in their order.
inline constexpr std::array kMetricWords = std::to_array<std::string_view>({
#define DISTANCE(id, Type, prepared, zero_is_unknown) #id,
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
});

/// Between directions: the length of a vector does not count, and the zero vector has none.
constexpr bool is_of_directions(Metric metric) {
    switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case Metric::id:                                  \
        return zero_is_unknown;
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
    return false;
}

using Aggregation = ast::AggregationKind;

/// d aggregated over a target set: AGG DIST(point, target).
struct Distance {
    Index point = 0;  ///< of Model::points
    Index target = 0;
    Metric metric = Metric::l2;
    Aggregation aggregation = Aggregation::min;
    std::uint32_t kth = 1;       ///< the n-th smallest, from 1, for Aggregation::kth
    std::vector<float> weights;  ///< mahalanobis: D x D row-major symmetric positive definite, or
                                 ///< its D diagonal elements; empty: not fitted yet
    bool weights_diagonal = false;
    Index weights_fitted = kNone;  ///< of Model::fitted
    std::string weights_path;  ///< file the weights came from, for dependency files; empty: literal
                               ///< or a target
    std::string text;          ///< canonical text, "min l2(z, goal_a)"
    Span span;

    /// mahalanobis by a whole matrix.
    bool full_weights() const { return metric == Metric::mahalanobis && !weights_diagonal; }
};

/// EXPR, evaluated in float32, each operation rounded once, in the order given.
struct Expr {
    using Kind = ast::ExprKind;
    Kind kind = Kind::number;
    std::string text;    ///< number: its decimal text
    double number = 0;   ///< the decimal text rounded to double: only truth formulas use it
    float number32 = 0;  ///< the decimal text rounded once to float32
    Index index = 0;     ///< scalar: input; distance: distance
    std::vector<Expr> arguments;
    Span span;
};

/// Visits EXPR and all that it is made of, the whole before its parts.
template <class Visit>
void for_each(const Expr& expression, const Visit& visit) {
    visit(expression);
    for (const Expr& argument : expression.arguments) for_each(argument, visit);
}

/// Visits the distances that EXPR reads, by index in the model, as often as each stands in it.
template <class Visit>
void for_each_distance(const Expr& expression, const Visit& visit) {
    for_each(expression, [&](const Expr& e) {
        if (e.kind == Expr::Kind::distance) visit(e.index);
    });
}

using ast::Comparison;

/// delta CMP epsilon
template <class Number>
bool holds(Comparison comparison, Number delta, Number epsilon) {
    switch (comparison) {
        case Comparison::less_equal: return delta <= epsilon;
        case Comparison::less: return delta < epsilon;
        case Comparison::greater_equal: return delta >= epsilon;
        case Comparison::greater: return delta > epsilon;
        case Comparison::equal: return delta == epsilon;
        case Comparison::not_equal: break;
    }
    return delta != epsilon;
}

/// What a monitor computes with: `--values`. Boolean: the comparison itself decides, and a
/// formula's value is true (+inf) or false (-inf). Sourced, `--explain`: robustness, and the sample
/// that it is that of.
enum class Values : std::uint8_t { robustness, boolean, sourced };

enum class ThresholdOrigin : std::uint8_t { literal, f1, conformal, class_conditional, adaptive };

/// How an adaptive threshold follows labels: by `widen` towards more detections after a positive
/// frame that it missed, by `tighten` the other way after one that it found, and never out of
/// `range`. All are multiples of `grid`, a power of two, and the ends of the range at most 2^24
/// times it, so no float32 sum of them is rounded.
struct Adaptation {
    std::string gamma;  ///< decimal texts, as written
    std::string lo;
    std::string hi;
    Range range;        ///< [lo, hi], rounded outward
    float widen = 0;    ///< gamma (1 - alpha), rounded up
    float tighten = 0;  ///< gamma alpha, rounded down
    float grid = 0;
};

struct Threshold {
    ThresholdOrigin origin = ThresholdOrigin::literal;
    std::string text;    ///< literal: its decimal text; calibrated: "calibrated(conformal, alpha =
                         ///< 0.10)" as canonical text
    std::string alpha;   ///< decimal text, where the method has one
    double value64 = 0;  ///< the literal's text rounded to double: only truth formulas use it
    float value = 0;  ///< epsilon; NaN where uncalibrated is allowed (calibrate reads such a model)
    std::uint64_t n = 0;                   ///< calibrated: how many scores it was chosen among
    std::uint64_t k = 0;                   ///< and its rank among them; 0 for f1
    std::optional<Adaptation> adaptation;  ///< of adaptive ones, whose `value` is where they start
    Span span;

    /// Every value that it may come to have.
    Range range() const { return adaptation ? adaptation->range : Range{value, value}; }
};

/// Definition "Embedding Predicate": (Z_target, d, epsilon, CMP, a), or EXPR CMP epsilon in
/// general. Robustness is epsilon - delta for <= and <, delta - epsilon for >= and >, one float32
/// subtraction, with the epsilon of that step. == and != have no margin: they are +inf or -inf.
struct Predicate {
    std::string name;  ///< empty for a comparison that stands in a formula
    std::string text;  ///< canonical text without the threshold: "min l2(z, goal_a) <= "
    Expr expression;
    Comparison comparison = Comparison::less_equal;
    Threshold threshold;
    Range delta;       ///< of the expression, by interval arithmetic, rounded outward
    Range robustness;  ///< of epsilon - delta or delta - epsilon for any epsilon it may have,
                       ///< rounded outward, and what a missing sample counts as; of a retargetable
                       ///< model everything
    std::optional<bool> missing;  ///< what it counts as where it is unknown; else its whole range
    std::vector<Index> inputs;    ///< all inputs it reads, ascending
    Span span;

    bool upper_bound() const {
        return comparison == Comparison::less_equal || comparison == Comparison::less;
    }
    bool equality() const {
        return comparison == Comparison::equal || comparison == Comparison::not_equal;
    }
    bool lower_bound() const { return !upper_bound() && !equality(); }
    /// What the comparison says of every value that its left side and its threshold can have;
    /// nothing where it says both.
    std::optional<bool> constant_answer() const;
    bool strict() const {
        return comparison == Comparison::less || comparison == Comparison::greater;
    }
    /// What messages call it: its name, or what it says.
    std::string shown() const { return name.empty() ? text + threshold.text : name; }
    /// A plain aggregated distance, not a general expression.
    bool plain_distance() const { return expression.kind == Expr::Kind::distance; }
    /// The distances that it reads, each once, in order; each has a nearest row.
    std::vector<Index> distances() const {
        std::vector<Index> found;
        for_each_distance(expression, [&](Index d) {
            if (std::find(found.begin(), found.end(), d) == found.end()) found.push_back(d);
        });
        return found;
    }
};

// ---- what must hold -----------------------------------------------------------------------------

struct Formula {
    /// The operators of the language: rise f is f && Y !f, fall f is !f && Y f, and held[0, n] f is
    /// H[0, n] f && O[n, n] true.
    enum class Kind : std::uint8_t {
        constant_true,
        constant_false,
        predicate,
        boolean_input,
#define OPERATOR(name, ...) name,
#include "ast/operators.def"
#undef OPERATOR
    };
    Kind kind = Kind::constant_true;
    Index index = 0;              ///< predicate or boolean_input
    std::vector<Index> operands;  ///< formulas; conjunction and disjunction have two or more
    std::uint32_t low = 0;        ///< interval, in steps; [1, 1] for next, previous, rise, fall
    std::uint32_t high = kUnbounded;
    Span span;
};

constexpr bool looks(Formula::Kind kind, ast::Looks where) {
    const ast::Operator* const op = ast::operator_of(kind);
    return op != nullptr && op->looks == where;
}
constexpr bool looks_ahead(Formula::Kind kind) {
    return looks(kind, ast::Looks::ahead);
}
constexpr bool looks_back(Formula::Kind kind) {
    return looks(kind, ast::Looks::back);
}

/// X, Y, rise and fall, whose interval [1, 1] is not written.
constexpr bool looks_one_step_away(Formula::Kind kind) {
    using Kind = Formula::Kind;
    return kind == Kind::next || kind == Kind::previous || kind == Kind::rise || kind == Kind::fall;
}

// ---- what is fitted to episodes -----------------------------------------------------------------

enum class FittedMethod : std::uint8_t {
    mean,
    medoids,
    kmeans,
    pca,
    whitened_pca,
    discriminant,
    logpzo,
};

/// fitted(METHOD, of = POINT, where = FORMULA, ...): numbers that `etlc fit` computes.
struct Fitted {
    enum class Slot : std::uint8_t { target, projection, metric };
    std::string name;         ///< of the target or projection; of a metric its declaration
    std::string declaration;  ///< canonical text: "fitted(kmeans, k = 64, of = Q(z), where = true)"
    FittedMethod method = FittedMethod::mean;
    /// The shape of what it gives: rows of a target, R x D of a map or metric.
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    std::uint32_t away = 0;  ///< steps between the frames taken and a change of `where`
    Index point = 0;         ///< of Model::points
    Index where = kNone;     ///< of Model::formulas, over truths: a predicate stands for its truth
    Slot slot = Slot::target;
    Index index = kNone;  ///< of the target or projection; the distances of a metric name it
    bool filled = false;
    Span span;
};

/// Which error a calibrated monitor is guaranteed against.
enum class Against : std::uint8_t { missed_alarm, missed_success };

/// `calibrated(conformal, alpha = 0.1, against = missed_alarm)` behind a formula: rho, lower and
/// upper are less by threshold.value.
struct MonitorCalibration {
    Threshold threshold;
    Against against = Against::missed_alarm;
};

/// When the position moves that a prefix monitor reports about; it is 0 at first.
enum class Restarts : std::uint8_t {
    never,
    on_request,  ///< restart_NAME(): to the next step
    when_final,  ///< and after each final verdict
};

struct Monitor {
    std::string name;
    Index formula = 0;
    bool sliding = false;
    Restarts restarts = Restarts::never;
    std::uint32_t horizon = 0;  ///< sliding: steps of delay; 0 otherwise
    std::optional<MonitorCalibration> calibration{};
    Span span;
};

struct Truth {
    Index predicate = 0;
    Index formula = 0;  ///< over recorded inputs; past operators only
    Span span;
};

struct Let {
    std::string name;
    Index formula = 0;
    Span span;
    bool telemetry = false;  ///< its verdict at the present step is kept: --lets
};

struct Constant {
    std::string name;
    std::string text;     ///< its value, "0.5" or "2 s"
    bool is_set = false;  ///< from outside, by --set
};

struct Model {
    std::string name;  ///< of the spec
    /// Thresholds, targets, projections and numbers may change between steps: all that is said of
    /// what may come holds whatever they are.
    bool retargetable = false;
    std::vector<Constant> constants;
    source::File file;        ///< for the lines that comments quote
    double step_seconds = 0;  ///< 0: no rate was given
    /// Durations that are not whole numbers of steps, as written, and what they were rounded to.
    std::map<std::string, std::uint32_t> rounded;
    std::string rounding;  ///< "up", "down" or "to the nearest"; empty: none is
    std::vector<Encoder> encoders;
    std::vector<Encoded> encoded;  ///< equal ones stand once
    std::vector<Input> inputs;
    std::vector<Projection> projections;
    std::vector<Point> points;  ///< equal ones stand once
    /// Declared ones, then the projected rows of some of them, for the distances that need these.
    std::vector<Target> targets;
    /// Each is fitted on the frames, and through projections that stand before it.
    std::vector<Fitted> fitted;
    std::vector<Distance> distances;    ///< equal ones stand once
    std::vector<Predicate> predicates;  ///< named ones first, in order of declaration, then those
                                        ///< that stand in formulas
    std::vector<Formula> formulas;
    std::vector<Let> lets;
    std::vector<Truth> truths;
    std::vector<Monitor> monitors;
    /// What a distance is measured from.
    const Point& point_of(Index distance) const { return points[distances[distance].point]; }

    std::vector<std::string> dependencies;  ///< paths of every file loaded, for --depfile, sorted
    /// What the thresholds' guarantees rest on besides exchangeable episodes, in words: that
    /// episodes which overlap were allowed, and why; that labels were not those of a truth.
    std::vector<std::string> reservations;
};

/// The formulas that a formula consists of, from itself down to its operands: descending.
std::vector<Index> parts_of(const Model& model, Index formula);

/// The formula as canonical text with symbols, minimal parentheses and names: "F (at_a && F at_b)".
/// Lets are written out, except in formulas of more than kMaxPrinted operators and atoms: there the
/// names of lets stand below the top.
std::string print(const Model& model, Index formula);
inline constexpr std::uint64_t kMaxPrinted = 1000;
bool lets_are_written_out(const Model& model, Index formula);

/// The formula for people to read: lets are written out, and parts of a long one left out
/// (check/model/elision.hpp).
std::string shown(const Model& model, Index formula);

/// The expression as canonical text: equal values of numbers are written alike.
std::string print(const Model& model, const Expr& expression);

}  // namespace etlc::check
