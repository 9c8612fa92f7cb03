// The spec as written: one plain struct a construct, each with its span. Names are not resolved,
// nothing is checked. Takes: what parse/ saw. Gives: check/ its input, and `--emit ast` its text.
// Keeps true: declarations stand in file order; && and || are n-ary, so a long chain is not a deep
// tree.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ast/operators.hpp"
#include "source/source.hpp"

namespace etlc::ast {

using source::Span;

struct Name {
    std::string text;
    Span span;
};

/// A decimal number, kept as its exact text: it rounds once, where it is used.
struct Number {
    std::string text;  ///< with a leading '-' where it was negated; or "inf", "-inf" (bounds and
                       ///< ranges only)
    Span span;
    std::string constant{};  ///< the constant that stands for it; until check/ puts its value into
                             ///< `text`, that is the name as well
};

// ---- expressions: EXPR --------------------------------------------------------------------------

struct MatrixLiteral {
    std::vector<std::vector<Number>> rows;
    Span span;
};

/// load("file.npy") or load("file.npz", "key")
struct Load {
    std::string path;
    std::string key;  ///< empty: none given
    Span path_span;
    Span key_span;
    Span span;
};

/// [1, 2, 3]: the diagonal of a weight matrix.
struct VectorLiteral {
    std::vector<Number> values;
    Span span;
};

/// frames("file.npz", "z", [120, 180]), or frames("file.npz", "z", [10, 50], stride = 5); of a
/// video frames("file.mp4", [120, 180])
struct Frames {
    std::string path;
    std::string key;             ///< empty: of a video
    std::vector<Number> frames;  ///< with a stride: the first and the last
    std::optional<Number> stride;
    Span path_span;
    Span key_span;
    Span frames_span;
    Span span;
};

/// images("bay/*.png")
struct Images {
    std::string path;  ///< of an image, a folder or a pattern
    Span path_span;
    Span span;
};

/// z, [px, py], P(z) or P(Q([px, py])).
struct Point {
    std::vector<Name> projections;  ///< from the outermost
    std::vector<Name> inputs;       ///< one embedding input, or the scalars of a vector
    bool is_vector = false;         ///< written with brackets
    Span span;
};

struct Formula;
using FormulaPtr = std::unique_ptr<Formula>;

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

/// M of mahalanobis(M): loaded, a literal matrix or diagonal, fitted, or the name of a target.
using Weights = std::variant<Load, MatrixLiteral, VectorLiteral, Fitted, Name>;

struct Aggregation {
    using Kind = AggregationKind;
    Kind kind = Kind::min;
    std::optional<Number> n;  ///< of kth(n)
    Span span;
};

/// AGG DIST(point, target)
struct Distance {
    std::optional<Aggregation> aggregation;
    Name metric;  ///< a word of distances.def; its span is the word's
    std::optional<Weights> weights;
    Point point;
    Name target;
    Span span;
};

struct Expr;
using ExprPtr = std::unique_ptr<Expr>;

struct Expr {
    using Kind = ExprKind;
    Kind kind = Kind::number;
    std::string text;                    ///< number: its digits; name: the input or constant
    std::string constant;                ///< number: the name that stood for it, as in Number
    std::unique_ptr<Distance> distance;  ///< kind distance
    /// Operands, in order; add and multiply etc. are binary, left-associated.
    std::vector<ExprPtr> arguments;
    Span span;
};

// ---- formulas -----------------------------------------------------------------------------------

/// The unit of what says that it is a number of steps: `2 steps`, `1 step`.
inline constexpr std::string_view kStepsUnit = "steps";

/// One bound of an interval, or of `held` or `hold`: steps, a duration, or inf.
struct Bound {
    Number number;
    std::string unit;  ///< "", "us", "ms", "s", "min", kStepsUnit
    Span span;
};

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
    std::string name;  ///< kind name
    /// Conjunction and disjunction: two or more; implication etc.: left, right.
    std::vector<FormulaPtr> operands;
    std::optional<Interval> interval;  ///< of held[D]: [0, D]
    ExprPtr left;                      ///< comparison: EXPR CMP EXPR
    Comparison comparison = Comparison::less_equal;
    ExprPtr right;
    Span operator_span;  ///< of the operator's own word or symbol
    Span span;
};

// ---- declarations -------------------------------------------------------------------------------

/// What becomes of a duration that is not a whole number of steps; exact: it is an error.
enum class Rounding : std::uint8_t { exact, up, down, nearest };

struct Rate {
    Number number;
    bool is_period = false;  ///< period N ms; else rate N Hz
    std::string unit;        ///< "Hz", or "us", "ms", "s", "min"; "": that of a constant
    Rounding durations = Rounding::exact;
    Span span;
};

std::string_view word(Rounding rounding);  ///< "up"

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

/// encoder NAME = load("model.onnx"), image [224, 224], mean [...], deviation [...]
struct Encoder {
    struct Setting {
        Name key;
        std::vector<Number> values;
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
    std::optional<bool> missing;  ///< what a sample that is not there counts as
    Span span;
};

/// P(z) = A (z - m)
struct Projection {
    using Numbers = std::variant<Load, MatrixLiteral, VectorLiteral>;

    Name name;
    std::variant<Load, MatrixLiteral, VectorLiteral, Fitted> matrix;
    std::optional<Numbers> offset;
    Span span;
};

struct Target {
    /// A VectorLiteral is an error that check/ explains.
    using Source = std::variant<Load, MatrixLiteral, VectorLiteral, Frames, Images, Fitted>;

    Name name;
    std::vector<Source> sources;  ///< one that is fitted stands alone
    std::optional<Name> encoder;  ///< `by NAME`: of the images and videos among the sources
    std::optional<Point> space;   ///< `of P(z)`
    Span span;
};

/// calibrated(METHOD, key = value, ...)
struct Calibrated {
    struct Argument {
        Name key;
        std::variant<Number, Name> value;
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
    std::optional<bool> missing;  ///< what it counts as where it is unknown
    Span span;
};

struct Truth {
    Name predicate;
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

using Declaration = std::variant<Rate, Constant, Encoder, Input, Projection, Target, Predicate,
                                 Truth, Let, Monitor>;

struct Spec {
    Name name;  ///< empty text: missing or unreadable, already reported
    std::vector<Declaration> declarations;
    /// Names of declarations that could not be read. check/ takes them as declared, so that one
    /// broken line does not make every use of its name an error too. The reserved word `rate`
    /// stands for a `rate` or `period` declaration.
    std::vector<Name> unreadable;
};

/// A spec rebuilt as text, one declaration a line in canonical form. `--emit ast`; parsing it again
/// gives the same tree.
std::string print(const Spec& spec);
std::string print(const Formula& formula);
std::string print(const Expr& expression);
std::string print(const Frames& frames);
std::string print(const Images& images);

}  // namespace etlc::ast
