// The typed spec: names resolved, numbers rounded, data loaded, everything checked. Later stages
// need nothing else and do not see the syntax tree. Every index is in range and every formula is
// well-typed; operands have smaller indices than their formula (formulas are a DAG in topological
// order, and a `let` is the node that it names).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ast/operators.hpp"
#include "check/numbers/range.hpp"
#include "etlmon/temporal/drift.hpp"
#include "source/source.hpp"

namespace etlc::check {

// Inputs, points and target sets of the model. Every index is in range.

using source::Span;
using Index = std::uint32_t;
inline constexpr Index kNone = std::numeric_limits<Index>::max();
/// Limit on the dimension of a point: 4 MiB in float32.
inline constexpr std::uint32_t kMaxDimension = 1U << 20U;

// ---- what the monitor sees ----------------------------------------------------------------------

enum class InputType : std::uint8_t { scalar, boolean, f32, f16, i8 };

/// A model that makes embeddings from images, and its preprocessing.
struct Encoder {
    std::string name;
    std::string model;             ///< the file as named in the spec
    std::string preprocessor;      ///< the same; or empty
    std::vector<float> image;      ///< rows and columns of what the model sees; or empty
    std::vector<float> mean;       ///< red, green, blue; or empty
    std::vector<float> deviation;  ///< red, green, blue; or empty
    std::string filter;            ///< "bilinear" or "bicubic", as in Pillow; or empty
    std::vector<float> resize;     ///< with a filter: shorter side, or rows and columns; or empty
    std::string flip;              ///< "horizontal", "vertical" or "both"; or empty
    std::string channels;          ///< "rgb" or "bgr"; or empty
    std::string margins;           ///< halves of them are rounded "even" or "down"; or empty
    std::string output;            ///< that is the embedding; empty: the only one
    std::string pool;              ///< "cls" or "mean": how tokens become one vector; or empty
    std::string declaration;       ///< canonical text
    std::uint32_t dimension = 0;   ///< of its inputs; 0 if there are none
    std::string fingerprint;       ///< embedded::fingerprint; empty before `etlc embed`
    /// Its embeddings of the reference frames, `dimension` elements each; empty before `etlc
    /// embed`.
    std::vector<float> references;
    /// Fingerprints of the same model in other runtimes, with the names of these.
    std::map<std::string, std::string> otherwise;
    Span span;
};

/// Images, or frames of a video, in a target.
struct Encoded {
    std::string text;  ///< canonical, "images(\"bay/*.png\") by dino"
    Index encoder = 0;
    std::string path;  ///< a file, folder or pattern as named in the spec
    bool is_video = false;
    std::vector<std::uint64_t> frames;  ///< of a video, in the order of the rows
    Span span;
};

struct Input {
    std::string name;
    InputType type = InputType::scalar;
    std::uint32_t dimension = 1;  ///< of embeddings
    float scale = 1.0F;           ///< value = scale x integer, for i8
    Range range;                  ///< of scalars; samples outside count as missing
    bool has_range = false;
    /// Number of successive missing samples that the last present one replaces.
    std::uint32_t hold = 0;
    std::optional<bool> missing;  ///< value of missing samples of a bool
    /// Number of equal samples in a row that count; later ones are missing. 0: all count.
    std::uint32_t stale_after = 0;
    Index encoder = kNone;  ///< makes it from images; in Model::encoders
    Span span;

    bool is_embedding() const { return type != InputType::scalar && type != InputType::boolean; }
    /// Returns whether a step uses earlier samples, so that every sample has to be looked at.
    bool has_state() const { return hold > 0 || stale_after > 0; }
};

/// A linear map of points: P(z) = A (z - m).
struct Projection {
    std::string name;
    std::uint32_t rows = 0;       ///< R, the dimension of P(z)
    std::uint32_t dimension = 0;  ///< D, the dimension of z
    std::vector<float> matrix;    ///< A: R x D, row-major, all finite; empty before fitting
    std::vector<float> offset;    ///< m: D, all finite; or empty
    std::string origin;           ///< "pca.npz:A", "literal" or "fitted", as in Target
    std::string path;             ///< of the matrix file; empty for a literal
    std::string hash;             ///< content hash of shape and values
    Index fitted = kNone;         ///< in Model::fitted
    std::string space;            ///< its points are those of all projections in it; or empty
    Span span;
};

/// A point to measure from: an embedding, a vector of scalars [px, py], P(POINT), POINT as it was
/// `steps` ago, several points put together, [z, z@5], or a sum, z - 2 * w, of points of one space.
/// A delayed point is none of the last three.
struct Point {
    enum class Kind : std::uint8_t { embedding, scalars, projected, delayed, joined, sum };
    Kind kind = Kind::embedding;
    std::vector<Index> inputs;  ///< all that it is made of, in order
    std::uint32_t dimension = 0;
    Index projection = kNone;  ///< P
    Index inner = kNone;       ///< POINT, which precedes it in Model::points
    std::uint32_t steps = 0;   ///< delayed: at least 1
    std::vector<Index> parts;  ///< joined: at least two, which precede it in Model::points; or sum
    std::vector<float> factors;  ///< sum: one for each part
    std::string text;            ///< canonical text: "Q(z)", "[px, py]", "z@90", "z - 2 * w"

    bool is_vector() const { return kind == Kind::scalars; }
    bool is_projected() const { return kind == Kind::projected; }
    bool is_delayed() const { return kind == Kind::delayed; }
    bool is_joined() const { return kind == Kind::joined; }
    bool is_sum() const { return kind == Kind::sum; }
};

/// Rows of a target that were made from images or from frames of a video.
struct EncodedRows {
    Index encoded = 0;  ///< in Model::encoded
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// Z_target: rows x dimension float32, row-major, all finite.
struct Target {
    std::string name;
    std::uint32_t rows = 0;
    std::uint32_t dimension = 0;
    std::vector<float> values;  ///< empty before fitting
    /// "targets/goal_a.npy", "file.npz:key" or "literal".
    std::string origin;
    std::string path;                  ///< of the file; empty for a literal
    std::string hash;                  ///< data::content_hash of shape and values
    std::vector<EncodedRows> encoded;  ///< rows made from images
    /// The point whose space contains the rows, in Model::points; kNone: the space of the inputs.
    Index space = kNone;
    /// The declared target whose rows were projected into `space`; kNone for declared targets.
    Index source = kNone;
    Index fitted = kNone;  ///< in Model::fitted
    Span span;
};

// Expressions of the model, and numbers that earlier steps have a part in.

/// EXPR, evaluated in float32 in the given order, where each operation rounds once.
struct Expr {
    using Kind = ast::ExprKind;
    Kind kind = Kind::number;
    std::string text;    ///< decimal text of a number
    double number = 0;   ///< rounded to double, for truth formulas only
    float number32 = 0;  ///< rounded once to float32
    Index index = 0;     ///< of the input, distance or past number
    std::vector<Expr> arguments;
    Span span;
};

/// Visits EXPR and its parts, the whole first.
template <class Visit>
void for_each(const Expr& expression, const Visit& visit) {
    visit(expression);
    for (const Expr& argument : expression.arguments) for_each(argument, visit);
}

/// Visits EXPR and its parts, the whole first, but not the parts of numbers that earlier steps have
/// a part in: what is computed at every step by itself.
template <class Visit>
void for_each_of_step(const Expr& expression, const Visit& visit) {
    visit(expression);
    if (expression.kind == Expr::Kind::past) return;
    for (const Expr& argument : expression.arguments) for_each_of_step(argument, visit);
}

/// Visits the distances in EXPR, by index, as often as each occurs.
template <class Visit>
void for_each_distance(const Expr& expression, const Visit& visit) {
    for_each(expression, [&](const Expr& e) {
        if (e.kind == Expr::Kind::distance) visit(e.index);
    });
}

/// A number that earlier steps have a part in: EXPR@n, mean(EXPR, n), where n counts steps. In a
/// predicate it is an Expr of kind `past`, whose argument is EXPR.
struct Past {
    using Kind = ast::PastKind;
    Kind kind = Kind::ago;
    Expr expression;  ///< EXPR; may contain earlier elements of Model::pasts
    std::uint32_t steps = 1;
    std::string text;  ///< canonical text: "mean(x, 60 steps)"
    Range range;       ///< of the number
    Span span;
};

// ---- what is measured ---------------------------------------------------------------------------

enum class Metric : std::uint8_t {
#define DISTANCE(id, Type, prepared, zero_is_unknown) id,
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
};

struct MetricRow {
    std::string_view word;
    bool is_of_directions;  ///< lengths do not count, and the zero vector has no direction
};

/// The rows of the metrics, in their order.
inline constexpr std::array kMetrics = std::to_array<MetricRow>({
#define DISTANCE(id, Type, prepared, zero_is_unknown) {#id, zero_is_unknown},
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
});

constexpr bool is_of_directions(Metric metric) {
    return kMetrics[static_cast<std::size_t>(metric)].is_of_directions;
}

using Aggregation = ast::AggregationKind;

/// Distances to a target set, aggregated: AGG DIST(point, target); or DIST(point, other).
struct Distance {
    Index point = 0;       ///< in Model::points
    Index target = kNone;  ///< kNone between two points
    Index other = kNone;   ///< in Model::points; kNone for a target
    Metric metric = Metric::l2;
    Aggregation aggregation = Aggregation::min;
    std::uint32_t kth = 1;  ///< the n-th smallest, from 1, for Aggregation::kth
    /// of mahalanobis: D x D row-major symmetric positive definite, or the D diagonal elements;
    /// empty before fitting
    std::vector<float> weights;
    bool weights_diagonal = false;
    Index weights_fitted = kNone;  ///< in Model::fitted
    /// file of the weights, for dependency files; empty for a literal or a target
    std::string weights_path;
    std::string text;  ///< canonical text, "min l2(z, goal_a)"
    Span span;

    bool is_between_points() const { return other != kNone; }
    /// Whether it is mahalanobis with a full matrix.
    bool full_weights() const { return metric == Metric::mahalanobis && !weights_diagonal; }
};

using ast::Comparison;

/// Evaluates delta CMP epsilon.
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

/// Returns what a comparison with two thresholds is called: true within `inner`, false beyond
/// `outer`, nothing between them or if delta is NaN.
inline std::optional<bool> called(Comparison comparison, float delta, float inner, float outer) {
    if (std::isnan(delta)) return std::nullopt;
    if (holds(comparison, delta, inner)) return true;
    if (!holds(comparison, delta, outer)) return false;
    return std::nullopt;
}

/// The values that a monitor computes with, `--values`. Boolean: comparisons decide, and formulas
/// are +inf or -inf. Sourced, for `--explain`: robustness with the sample that determines it.
enum class Values : std::uint8_t { robustness, boolean, sourced };

enum class ThresholdOrigin : std::uint8_t {
    literal,
    f1,
    conformal,
    class_conditional,
    adaptive,
    risk,
    normal,  ///< conformal, with every frame of every demonstration as positive
};

/// The error that a calibration bounds: of a predicate a miss or a false positive, of a monitor a
/// missed success (violated where its truth is satisfied) or a missed alarm (satisfied where its
/// truth is violated), or both of these kinds.
enum class Against : std::uint8_t { misses, false_positives, missed_alarm, missed_success, both };

/// Updates of an adaptive threshold: `widen` towards more detections after a missed positive frame,
/// `tighten` the other way after a detected one, within `range`. All are multiples of `grid`, a
/// power of two, and the ends of the range at most 2^24 times it, so no float32 sum of them is
/// rounded.
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
    /// decimal text of a literal, or canonical text "calibrated(conformal, alpha = 0.10)"
    std::string text;
    std::string alpha;  ///< decimal text; empty for methods without alpha
    std::string beta;   ///< likewise, of false positives or missed alarms if it is not alpha
    Against against = Against::misses;
    std::uint32_t within = 0;  ///< steps around a change of the truth at which labels are unknown
    double value64 = 0;        ///< literal rounded to double, for truth formulas only
    float value = 0;           ///< epsilon; NaN before calibration
    /// The second threshold, against both errors: what lies within `inner` is called true, what
    /// lies beyond `value` false, and neither between them. Either may be infinite, but not both.
    std::optional<float> inner;
    std::uint64_t n = 0;  ///< calibrated: number of scores
    std::uint64_t k = 0;  ///< rank among them; 0 for f1 and risk, n + 1 if `value` is infinite
    std::uint64_t inner_n = 0;  ///< the same of the threshold against false positives, if both
    std::uint64_t inner_k = 0;
    bool by_group = false;                 ///< conformal: a score for each group of episodes
    std::optional<Adaptation> adaptation;  ///< of adaptive thresholds, which start at `value`
    Span span;

    /// Whether it bounds the probability of an error in an episode, whatever its length.
    bool bounds_episodes() const {
        return origin == ThresholdOrigin::conformal || origin == ThresholdOrigin::normal;
    }
    /// Returns the threshold within which the predicate is called true.
    float low() const { return inner.value_or(value); }
    /// Returns the rate of false positives or missed alarms that a calibration against them allows.
    const std::string& rate_of_false_positives() const { return beta.empty() ? alpha : beta; }
    /// Returns the range of all values that it may take.
    Range range() const {
        if (adaptation) return adaptation->range;
        return {std::min(low(), value), std::max(low(), value)};
    }
};

/// Definition "Embedding Predicate": (Z_target, d, epsilon, CMP, a), or EXPR CMP epsilon in
/// general. Robustness is epsilon - delta for <= and <, delta - epsilon for >= and >: one float32
/// subtraction with the current epsilon. == and != have no margin and give +inf or -inf.
struct Predicate {
    std::string name;  ///< empty for comparisons in formulas
    std::string text;  ///< canonical text without the threshold: "min l2(z, goal_a) <= "
    Expr expression;
    Comparison comparison = Comparison::less_equal;
    Threshold threshold;
    Range delta;  ///< of the expression, by interval arithmetic, rounded outward
    /// of robustness for any epsilon, rounded outward, including the value for missing samples;
    /// everything if retargetable
    Range robustness;
    std::optional<bool> missing;  ///< value if unknown; otherwise its whole range
    std::vector<Index> inputs;    ///< all inputs that it reads, ascending
    Span span;

    bool upper_bound() const {
        return comparison == Comparison::less_equal || comparison == Comparison::less;
    }
    bool equality() const {
        return comparison == Comparison::equal || comparison == Comparison::not_equal;
    }
    bool lower_bound() const { return !upper_bound() && !equality(); }
    /// Returns the answer of the comparison if all values of its left side and threshold give the
    /// same.
    std::optional<bool> constant_answer() const;
    bool strict() const {
        return comparison == Comparison::less || comparison == Comparison::greater;
    }
    /// Returns what it is called where its left side is `left`.
    std::optional<bool> called(float left) const {
        return check::called(comparison, left, threshold.low(), threshold.value);
    }
    /// Returns its name, or the comparison, for messages.
    std::string shown() const { return name.empty() ? text + threshold.text : name; }
    /// Whether the expression is a single aggregated distance.
    bool plain_distance() const { return expression.kind == Expr::Kind::distance; }
    /// Returns the distances that it reads, each once, in order.
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
    /// The operators of the language. rise f is f && Y !f, fall f is !f && Y f, and held[0, n] f is
    /// H[0, n] f && O[n, n] true.
    enum class Kind : std::uint8_t {
        constant_true,
        constant_false,
        predicate,
        boolean_input,
#define OPERATOR(name, ...) name,
#include "ast/operators.def"
#undef OPERATOR
        count,  ///< count(f, D) >= n: rise f at n or more of the positions of [0, high]; also a
                ///< fraction(f, D), then f at `each_step`
    };
    Kind kind = Kind::constant_true;
    Index index = 0;              ///< of the predicate or boolean input; n of a count
    bool each_step = false;       ///< it counts where its operand holds, not where it begins to
    std::vector<Index> operands;  ///< two or more for conjunction and disjunction
    std::uint32_t low = 0;        ///< interval in steps; [1, 1] for next, previous, rise, fall
    std::uint32_t high = kUnbounded;
    /// Whether `high` is written in the spec, or the calibrated duration of its monitor; until that
    /// is known, a short one.
    enum class Time : std::uint8_t { written, open, calibrated };
    Time time = Time::written;
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

/// Returns how many steps back the operator reads its operands; kUnbounded for no limit.
constexpr std::uint32_t steps_back(const Formula& formula) {
    if (!looks_back(formula.kind)) return 0;
    const bool reads_before = formula.kind == Formula::Kind::count && !formula.each_step;
    return formula.high + (reads_before ? 1 : 0);
}

/// Whether the interval is an implicit [1, 1]: X, Y, rise and fall.
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
    std::string name;         ///< of the target or projection; for a metric its declaration
    std::string declaration;  ///< canonical text: "fitted(kmeans, k = 64, of = Q(z), where = true)"
    FittedMethod method = FittedMethod::mean;
    /// Shape of the result: rows of a target, R x D of a map or metric.
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    std::uint32_t away = 0;  ///< least number of steps between frames and a change of `where`
    Index point = 0;         ///< in Model::points
    Index where = kNone;     ///< in Model::formulas, where predicates stand for their truths
    Slot slot = Slot::target;
    Index index = kNone;  ///< of the target or projection; distances refer to metrics
    bool filled = false;
    Span span;
};

/// When a prefix monitor moves from position 0 to another.
enum class Restarts : std::uint8_t {
    never,
    on_request,  ///< restart_NAME() moves it to the next step
    when_final,  ///< also after each final verdict
};

/// `calibrated(conformal, alpha = 0.1)` in place of a duration in the formula of a monitor: the
/// upper bound of an interval, or the time of held or count.
struct Duration {
    Threshold threshold;         ///< its method, alpha, scores and place; it has no value
    std::uint32_t least = 0;     ///< the shortest that may stand there, in steps
    std::uint32_t greatest = 0;  ///< the longest
    std::uint32_t steps = 0;     ///< after calibration
    bool is_known = false;
    bool longer_is_truer = true;  ///< otherwise a longer one makes the monitor falser
};

struct Monitor {
    std::string name;
    Index formula = 0;
    bool sliding = false;
    Restarts restarts = Restarts::never;
    std::uint32_t horizon = 0;  ///< delay of a sliding monitor in steps; otherwise 0
    /// Number of steps that the formula of a repeating monitor looks ahead, after which a verdict
    /// is final even if it is unknown; kUnbounded of other monitors and without a limit.
    std::uint32_t ahead = kUnbounded;
    /// `calibrated(conformal, alpha = 0.1, against = missed_alarm)` after the formula: a threshold
    /// of rho. Its `value` is subtracted from the high end of rho and from `upper`, its low() from
    /// the low end and from `lower`.
    std::optional<Threshold> calibration{};
    /// The duration in its formula that is calibrated; a monitor has one at most.
    std::optional<Duration> duration{};
    Span span;
    /// The formula with the truths of lets in place of these lets; kNone: the formula itself.
    Index truth = kNone;

    /// Returns the formula of the ground-truth monitor, in which predicates stand for their truths.
    Index true_formula() const { return truth == kNone ? formula : truth; }
};

/// `drift NAME = of PREDICATE_OR_MONITOR, level = L`, about the scores of one of them.
struct Drift {
    std::string name;
    Index predicate = kNone;
    Index monitor = kNone;
    std::string level;           ///< decimal text
    etlmon::DriftCells cells{};  ///< of the scores of calibration; all 0 before
    Span span;

    bool is_calibrated() const { return cells.id != 0; }
};

struct Truth {
    Index predicate = 0;
    Index formula = 0;  ///< over recorded inputs, with past operators only
    Span span;
};

struct Let {
    std::string name;
    Index formula = 0;
    Span span;
    bool telemetry = false;  ///< its verdict at the present step is recorded: --lets
    /// Its truth, in which predicates stand for theirs; kNone: its formula over these.
    Index truth = kNone;
};

struct Constant {
    std::string name;
    std::string text;     ///< its value, "0.5" or "2 s"
    bool is_set = false;  ///< by --set
};

struct Model {
    std::string name;  ///< of the spec
    /// Thresholds, targets, projections and numbers may change between steps, so bounds on future
    /// values must hold for all of them.
    bool retargetable = false;
    std::vector<Constant> constants;
    source::File file;        ///< for quoted lines
    double step_seconds = 0;  ///< 0 without a rate
    /// Durations that are not whole numbers of steps, as written, with their rounded values.
    std::map<std::string, std::uint32_t> rounded;
    std::string rounding;  ///< "up", "down" or "to the nearest"; empty if not allowed
    std::vector<Encoder> encoders;
    std::vector<Encoded> encoded;  ///< without duplicates
    std::vector<Input> inputs;
    std::vector<Projection> projections;
    std::vector<Point> points;  ///< without duplicates
    /// Declared targets, then projected ones that distances need.
    std::vector<Target> targets;
    /// Each depends only on projections before it.
    std::vector<Fitted> fitted;
    std::vector<Distance> distances;  ///< without duplicates
    std::vector<Past> pasts;          ///< without duplicates, each after those that it contains
    /// named ones in order of declaration, then those in formulas
    std::vector<Predicate> predicates;
    std::vector<Formula> formulas;
    std::vector<Let> lets;
    std::vector<Truth> truths;
    std::vector<Monitor> monitors;
    std::vector<Drift> drifts;
    /// Returns the point of a distance.
    const Point& point_of(Index distance) const { return points[distances[distance].point]; }
    /// Returns the dimension of the points of a distance.
    std::uint32_t dimension_of(Index distance) const { return point_of(distance).dimension; }
    /// Returns the number of rows that a distance is aggregated over: 1 between two points.
    std::uint32_t rows_of(Index distance) const {
        const Index target = distances[distance].target;
        return target == kNone ? 1 : targets[target].rows;
    }

    std::vector<std::string> dependencies;  ///< paths of all loaded files, sorted, for --depfile
    /// Conditions of the guarantees besides exchangeable episodes, in words: allowed overlaps of
    /// episodes with reasons, and labels that did not come from a truth.
    std::vector<std::string> reservations;
};

/// Returns the distances to target sets that a predicate reads, each once, in order.
std::vector<Index> measured_targets(const Model& model, const Predicate& predicate);

/// Returns the let of that formula that has a truth of its own; otherwise null.
const Let* let_with_truth(const Model& model, Index formula);

/// Returns the formulas that a formula consists of, from itself down to its operands: descending.
std::vector<Index> parts_of(const Model& model, Index formula);

/// Sets the duration in the formula of the monitor, and in that of its truth.
void set_duration(Model& model, const Monitor& monitor, std::uint32_t steps,
                  Formula::Time time = Formula::Time::calibrated);

/// Returns canonical text with symbols, minimal parentheses and names: "F (at_a && F at_b)". Lets
/// are written out unless the formula has more than kMaxPrinted operators and atoms; then names of
/// lets are used below the top.
std::string print(const Model& model, Index formula);
/// Returns the shortest decimal that k of n steps are the least number for: "0.8" for 40 of 50.
std::string share_text(std::uint32_t k, std::uint32_t n);
inline constexpr std::uint64_t kMaxPrinted = 1000;
bool lets_are_written_out(const Model& model, Index formula);

/// Returns the formula for people: lets are written out, and parts of a long one left out
/// (check/model/elision.hpp).
std::string shown(const Model& model, Index formula);

/// Returns canonical text, in which equal numbers look alike.
std::string print(const Model& model, const Expr& expression);

}  // namespace etlc::check
