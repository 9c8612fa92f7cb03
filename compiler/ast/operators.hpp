// The operators of the language, how they are written and how tightly they bind, for the tree and
// the typed model.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace etlc::ast {

// ---- formulas -----------------------------------------------------------------------------------

/// Binding levels of formulas, loosest first.
enum FormulaLevel : std::uint8_t {
    kIff,
    kImplies,
    kOr,
    kAnd,
    kBinary,
    kPrefix,
    kComparison,
    kAtom
};

/// Direction of time in which an operator looks.
enum class Looks : std::uint8_t { nowhere, ahead, back };

struct Operator {
    std::string_view symbol;  ///< "F"
    std::string_view word;    ///< "eventually"
    FormulaLevel level;
    Looks looks;
};

inline constexpr std::array kOperators = std::to_array<Operator>({
#define OPERATOR(name, token, symbol, word, level, looks) {symbol, word, level, Looks::looks},
#include "ast/operators.def"
#undef OPERATOR
    {"count", "count", kAtom, Looks::back},  // in the model alone; as written it is a comparison
});

/// Returns the row of an operator; null for atoms. `Kind` is that of the syntax tree or of the
/// model.
template <class Kind>
constexpr const Operator* operator_of(Kind kind) {
    if (kind < Kind::negation) return nullptr;
    return &kOperators[static_cast<std::size_t>(kind) - static_cast<std::size_t>(Kind::negation)];
}

// ---- expressions --------------------------------------------------------------------------------

enum class Comparison : std::uint8_t {
    less_equal,
    less,
    greater_equal,
    greater,
    equal,
    not_equal,
};

constexpr std::string_view symbol(Comparison comparison) {
    constexpr std::array<std::string_view, 6> kSymbols{"<=", "<", ">=", ">", "==", "!="};
    return kSymbols[static_cast<std::size_t>(comparison)];
}

/// Aggregation of the distances to all rows of a target.
enum class AggregationKind : std::uint8_t { min, max, mean, kth };

constexpr std::string_view word(AggregationKind kind) {
    constexpr std::array<std::string_view, 4> kWords{"min", "max", "mean", "kth"};
    return kWords[static_cast<std::size_t>(kind)];
}

/// Numbers that earlier steps have a part in: the value of an expression a while ago, its mean,
/// least and greatest value within a time, how often a formula began to hold within a time, and at
/// which share of its steps it held.
enum class PastKind : std::uint8_t { ago, mean, min, max, count, fraction };

constexpr std::string_view word(PastKind kind) {
    constexpr std::array<std::string_view, 6> kWords{"@",   "mean",  "min",
                                                     "max", "count", "fraction"};
    return kWords[static_cast<std::size_t>(kind)];
}

enum class ExprKind : std::uint8_t {
    number,
    name,           ///< an input or a constant
    scalar = name,  ///< in the model, names are scalar inputs
    distance,
    past,
    negate,
    add,
    subtract,
    multiply,
    divide,
    abs,
    sqrt,
    min,
    max
};

/// Binding levels of expressions, loosest first.
enum ExprLevel : std::uint8_t { kSum, kProduct, kSign, kPrimary };

struct ExprOperator {
    std::string_view text;  ///< operator or function
    ExprLevel level;
};

constexpr ExprOperator operator_of(ExprKind kind) {
    constexpr std::array kTexts = std::to_array<ExprOperator>({{"", kPrimary},
                                                               {"", kPrimary},
                                                               {"", kPrimary},
                                                               {"", kPrimary},
                                                               {"-", kSign},
                                                               {" + ", kSum},
                                                               {" - ", kSum},
                                                               {" * ", kProduct},
                                                               {" / ", kProduct},
                                                               {"abs", kPrimary},
                                                               {"sqrt", kPrimary},
                                                               {"min", kPrimary},
                                                               {"max", kPrimary}});
    return kTexts[static_cast<std::size_t>(kind)];
}

/// Appends an expression to the text in linear time, in brackets where it binds looser than
/// `needed`. `leaf` returns the text of numbers, names, distances and past numbers; `argument`
/// returns the expression behind an element of `arguments`.
template <class Expr, class Leaf, class Argument>
void append(std::string& text, const Expr& e, const Leaf& leaf, const Argument& argument,
            ExprLevel needed = kSum) {
    const auto [written, level] = operator_of(e.kind);
    const auto append_argument = [&](std::size_t i, int least) {
        append(text, argument(e.arguments[i]), leaf, argument, static_cast<ExprLevel>(least));
    };
    if (written.empty()) {
        text += leaf(e);
    } else if (level == kPrimary) {
        text.append(written) += '(';
        for (std::size_t i = 0; i < e.arguments.size(); ++i) {
            if (i > 0) text += ", ";
            append_argument(i, kSum);
        }
        text += ')';
    } else if (level == kSign) {
        text += written;
        append_argument(0, kSign);
    } else {
        if (level < needed) text += '(';
        append_argument(0, level);
        text += written;
        append_argument(1, level + 1);  // left associative
        if (level < needed) text += ')';
    }
}

}  // namespace etlc::ast
