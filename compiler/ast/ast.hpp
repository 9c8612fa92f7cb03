// The spec as written: one plain struct for each construct, with its span. Names are not resolved
// and nothing is checked. Declarations are in file order; && and || are n-ary, so a long chain is
// not a deep tree.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ast/operators.hpp"
#include "source/source.hpp"

namespace etlc::ast {

using source::Span;

/// Owns a part of the tree, or nothing. A copy has its own.
template <class T>
class Owned : public std::unique_ptr<T> {
public:
    using std::unique_ptr<T>::unique_ptr;
    Owned(std::unique_ptr<T> part) : std::unique_ptr<T>(std::move(part)) {}
    Owned(const Owned& other) : std::unique_ptr<T>(other ? std::make_unique<T>(*other) : nullptr) {}
    Owned(Owned&&) noexcept = default;
    Owned& operator=(const Owned& other) { return *this = Owned(other); }
    Owned& operator=(Owned&&) noexcept = default;
    ~Owned() = default;
};

struct Name {
    std::string text;
    Span span;
};

/// A decimal number as its exact text, which is rounded once, where it is used.
struct Number {
    /// with a leading '-' where it was negated; "inf" or "-inf" in bounds and ranges only
    std::string text;
    Span span;
    /// name of the constant used here; `text` is that name too until check/ substitutes the value
    std::string constant{};
};

// ---- expressions: EXPR --------------------------------------------------------------------------

/// The unit of explicit numbers of steps: `2 steps`, `1 step`.
inline constexpr std::string_view kStepsUnit = "steps";

struct MatrixLiteral {
    std::vector<std::vector<Number>> rows;
    Span span;
};

/// load("file.npy") or load("file.npz", "key")
struct Load {
    std::string path;
    std::string key;  ///< empty if none was given
    Span path_span;
    Span key_span;
    Span span;
};

/// [1, 2, 3], the diagonal of a weight matrix.
struct VectorLiteral {
    std::vector<Number> values;
    Span span;
};

/// frames("file.npz", "z", [120, 180]), or frames("file.npz", "z", [10, 50], stride = 5); for a
/// video frames("file.mp4", [120, 180]).
struct Frames {
    std::string path;
    std::string key;             ///< empty for a video
    std::vector<Number> frames;  ///< with a stride, the first and the last
    std::optional<Number> stride;
    Span path_span;
    Span key_span;
    Span frames_span;
    Span span;
};

/// images("bay/*.png")
struct Images {
    std::string path;  ///< an image, a folder or a pattern
    Span path_span;
    Span span;
};

/// One bound of an interval, or the time in `held`, `hold`, `stale after` or `@`: steps, a
/// duration, or inf.
struct Calibrated;

struct Bound {
    Number number;
    std::string unit;  ///< "", "us", "ms", "s", "min", kStepsUnit
    Span span;
    Owned<Calibrated> calibrated{};  ///< in place of the number, where it is not null
};

/// z, P(POINT), [px, py], [z, P(z)], z - 2 * w, each as it is or was: POINT@3s.
struct Point {
    Name name;                    ///< the input or projection; empty with brackets
    std::vector<Point> parts;     ///< of P(POINT) its POINT; with brackets or in a sum, all of them
    bool is_vector = false;       ///< written with brackets
    std::vector<Number> factors;  ///< in a sum, one for each part: "1", "-2"
    std::vector<Bound> delays;
    Span span;

    /// Whether it is only a name, which may be that of a target.
    bool is_name() const { return !is_vector && parts.empty() && delays.empty(); }
};

/// Returns the span of the alternative that a variant holds.
template <class... Alternatives>
Span span_of(const std::variant<Alternatives...>& value) {
    return std::visit([](const auto& v) { return v.span; }, value);
}

struct Formula;
using FormulaPtr = Owned<Formula>;

/// fitted(METHOD, of = POINT, where = FORMULA, NAME = NUMBER)
struct Fitted {
    struct Argument {
        Name key;
        std::variant<Number, Point, FormulaPtr> value;
    };
    Name method;
    std::vector<Argument> arguments;
    Span span;
};

/// M in mahalanobis(M): loaded, a literal matrix or diagonal, fitted, or the name of a target.
using Weights = std::variant<Load, MatrixLiteral, VectorLiteral, Fitted, Name>;

struct Aggregation {
    using Kind = AggregationKind;
    Kind kind = Kind::min;
    std::optional<Number> n;  ///< n in kth(n)
    Span span;
};

/// AGG DIST(point, target), or DIST(point, point)
struct Distance {
    std::optional<Aggregation> aggregation;
    Name metric;  ///< a word of distances.def
    std::optional<Weights> weights;
    Point point;
    Point other;  ///< the target, or another point
    Span span;
};

/// A number that earlier steps have a part in: EXPR@3s, mean(EXPR, 2s), count(FORMULA, 60s).
struct Past {
    using Kind = PastKind;
    Kind kind = Kind::ago;
    FormulaPtr formula;  ///< of a count or a fraction
    Bound time;
};

struct Expr;
using ExprPtr = Owned<Expr>;

struct Expr {
    using Kind = ExprKind;
    Kind kind = Kind::number;
    std::string text;          ///< digits of a number, or name of an input or constant
    std::string constant;      ///< name of the constant that gave the number, as in Number
    Owned<Distance> distance;  ///< only for kind distance
    Owned<Past> past;          ///< only for kind past
    /// Operands in order; add, multiply etc. are binary and associate to the left. The EXPR of a
    /// past number.
    std::vector<ExprPtr> arguments;
    Span span;
};

// ---- formulas -----------------------------------------------------------------------------------

struct Interval {
    Bound low;
    Bound high;
    Span span;
};

struct Formula {
    enum class Kind : std::uint8_t {
        constant_true,
        constant_false,
        name,
        comparison,
#define OPERATOR(name, ...) name,
#include "ast/operators.def"
#undef OPERATOR
    };
    Kind kind = Kind::constant_true;
    std::string name;  ///< only for kind name
    /// Two or more for conjunction and disjunction; left and right for implication etc.
    std::vector<FormulaPtr> operands;
    std::optional<Interval> interval;  ///< [0, D] for held[D]
    ExprPtr left;                      ///< EXPR CMP EXPR, for kind comparison
    Comparison comparison = Comparison::less_equal;
    ExprPtr right;
    Span operator_span;  ///< only the operator's word or symbol
    Span span;
};

// ---- declarations -------------------------------------------------------------------------------

/// Rounding of a duration that is not a whole number of steps; with `exact` it is an error.
enum class Rounding : std::uint8_t { exact, up, down, nearest };

struct Rate {
    Number number;
    bool is_period = false;  ///< period N ms; otherwise rate N Hz
    std::string unit;  ///< "Hz", or "us", "ms", "s", "min"; empty where a constant has the unit
    Rounding durations = Rounding::exact;
    Span span;
};

std::string_view word(Rounding rounding);

/// const NAME = NUMBER UNIT
struct Constant {
    Name name;
    Number value;
    std::string unit;  ///< "", "us", "ms", "s", "min", kStepsUnit
    Span span;
};

struct Type {
    enum class Kind : std::uint8_t { f32, f16, i8, boolean };
    Kind kind = Kind::f32;
    std::optional<Number> dimension;  ///< [D]
    std::optional<Number> scale;      ///< i8[D] scale S
    Span span;
};

struct Range {
    Number low;
    Number high;
    Span span;
};

/// encoder NAME = load("model.onnx"), resize bicubic [256], image [224, 224], mean [...]
struct Encoder {
    struct Setting {
        Name key;
        std::optional<Name> word;
        bool is_quoted = false;  ///< the word
        std::vector<Number> values;
        std::optional<Load> file;
        Span span;
    };
    Name name;
    Load model;
    std::vector<Setting> settings;
    Span span;
};

struct Input {
    std::vector<Name> names;
    Type type;
    std::optional<Name> encoder;  ///< `by NAME`
    std::optional<Range> range;
    std::optional<Bound> hold;
    std::optional<bool> missing;  ///< value that replaces a missing sample
    std::optional<Bound> stale;   ///< `stale after D`
    Span span;
};

/// P(z) = A (z - m)
struct Projection {
    using Numbers = std::variant<Load, MatrixLiteral, VectorLiteral>;

    Name name;
    std::variant<Load, MatrixLiteral, VectorLiteral, Fitted> matrix;
    std::optional<Numbers> offset;
    std::optional<Name> space;  ///< `in actions`
    Span span;
};

struct Target {
    /// A VectorLiteral is an error, which check/ explains.
    using Source = std::variant<Load, MatrixLiteral, VectorLiteral, Frames, Images, Fitted>;

    Name name;
    std::vector<Source> sources;  ///< a fitted source is the only one
    std::optional<Name> encoder;  ///< `by NAME`, for the images and videos among the sources
    std::optional<Point> space;   ///< `of P(z)`
    Span span;
};

/// calibrated(METHOD, key = value, ...)
struct Calibrated {
    struct Argument {
        Name key;
        std::variant<Bound, Name> value;  ///< a number or a time; a word
    };
    Name method;
    std::vector<Argument> arguments;
    Span span;
};

struct Predicate {
    Name name;
    ExprPtr expression;
    Comparison comparison = Comparison::less_equal;
    std::variant<ExprPtr, Calibrated> threshold;
    std::optional<bool> missing;  ///< value of the predicate where it is unknown
    Span span;
};

struct Truth {
    Name subject;  ///< a predicate or a let
    FormulaPtr formula;
    Span span;
};

struct Let {
    Name name;
    FormulaPtr formula;
    Span span;
};

struct Monitor {
    enum class Kind : std::uint8_t { prefix, sliding, restartable, repeating };
    Kind kind = Kind::prefix;
    Name name;
    FormulaPtr formula;
    std::optional<Calibrated> calibrated;
    Span span;
};

/// drift NAME = of PREDICATE_OR_MONITOR, level = L
struct Drift {
    Name name;
    Name of;
    std::vector<Calibrated::Argument> arguments;
    Span span;
};

using Declaration = std::variant<Rate, Constant, Encoder, Input, Projection, Target, Predicate,
                                 Truth, Let, Monitor, Drift>;

struct Spec {
    Name name;  ///< empty if missing or unreadable, which has been reported
    std::vector<Declaration> declarations;
    /// Names in declarations that could not be read. check/ takes them as declared, so that one
    /// broken line does not make every use of its name an error. The reserved word `rate` stands
    /// for a `rate` or `period` declaration.
    std::vector<Name> unreadable;
};

/// Prints a spec in canonical form, one declaration a line, for `--emit ast`; parsing the text
/// gives the same tree.
std::string print(const Spec& spec);
std::string print(const Formula& formula);
std::string print(const Expr& expression);
std::string print(const Frames& frames);
std::string print(const Images& images);

}  // namespace etlc::ast
