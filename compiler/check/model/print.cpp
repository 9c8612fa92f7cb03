// Canonical text of formulas and expressions: symbols, and parentheses only where the grammar needs
// them.
#include <string_view>
#include <unordered_map>

#include "check/model/elision.hpp"
#include "check/model/model.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using Kind = Formula::Kind;

/// From loosest to tightest, as in docs/language.md.
enum Level : int { kIff = 1, kImplies, kOr, kAnd, kUntil, kPrefix, kAtom };

struct Operator {
    std::string_view symbol;
    Level level;
};

Operator operator_of(Kind kind) {
    switch (kind) {
        case Kind::equivalence: return {"<->", kIff};
        case Kind::implication: return {"->", kImplies};
        case Kind::disjunction: return {"||", kOr};
        case Kind::conjunction: return {"&&", kAnd};
        case Kind::until: return {"U", kUntil};
        case Kind::weak_until: return {"W", kUntil};
        case Kind::release: return {"R", kUntil};
        case Kind::since: return {"S", kUntil};
        case Kind::negation: return {"!", kPrefix};
        case Kind::next: return {"X", kPrefix};
        case Kind::eventually: return {"F", kPrefix};
        case Kind::always: return {"G", kPrefix};
        case Kind::previous: return {"Y", kPrefix};
        case Kind::once: return {"O", kPrefix};
        case Kind::historically: return {"H", kPrefix};
        case Kind::rise: return {"rise", kPrefix};
        case Kind::fall: return {"fall", kPrefix};
        case Kind::held: return {"held", kPrefix};
        case Kind::constant_true: return {"true", kAtom};
        case Kind::constant_false: return {"false", kAtom};
        case Kind::predicate:
        case Kind::boolean_input: break;
    }
    return {"", kAtom};
}

class Phrases {
public:
    /// `let_names` stand for formulas below the root.
    Phrases(const Model& model, Index root, std::unordered_map<Index, std::string> let_names = {})
        : model_(model), root_(root), let_names_(std::move(let_names)) {}

    Phrase operator()(Index index) const {
        if (const auto* name = let_name(index)) return {.opening = *name};
        const Formula& formula = model_.formulas[index];
        const Operator op = operator_of(formula.kind);
        if (op.level == kAtom) return {.opening = atom(formula, op)};
        const std::string symbol = std::string(op.symbol) + interval(formula);
        Phrase phrase;
        if (op.level < kPrefix) phrase.separator = ' ' + symbol + ' ';
        if (op.level == kPrefix)
            phrase.opening = formula.kind == Kind::negation ? symbol : symbol + ' ';
        for (std::size_t i = 0; i < formula.operands.size(); ++i)
            phrase.operands.push_back(
                {formula.operands[i], level(formula.operands[i]) < weakest(op.level, i == 0)});
        return phrase;
    }

private:
    const std::string* let_name(Index index) const {
        const auto let = let_names_.find(index);
        return let != let_names_.end() && index != root_ ? &let->second : nullptr;
    }

    int level(Index index) const {
        return let_name(index) != nullptr ? kAtom : operator_of(model_.formulas[index].kind).level;
    }

    /// The loosest operator that an operand may have without parentheses.
    static int weakest(Level level, bool first) {
        if (level == kPrefix) return kPrefix;
        const bool left_associative = level == kIff;
        const bool right_associative = level == kImplies || level == kUntil;
        const bool tighter = (right_associative && first) || (left_associative && !first);
        return level + (tighter ? 1 : 0);
    }

    std::string atom(const Formula& formula, const Operator& op) const {
        if (formula.kind == Kind::boolean_input) return model_.inputs[formula.index].name;
        if (formula.kind != Kind::predicate) return std::string(op.symbol);
        return model_.predicates[formula.index].shown();
    }

    static std::string interval(const Formula& formula) {
        if (looks_one_step_away(formula.kind)) return "";
        if (formula.kind == Kind::held) return '[' + std::to_string(formula.high) + ']';
        if (formula.low == 0 && formula.high == kUnbounded) return "";
        const std::string high = formula.high == kUnbounded ? "inf" : std::to_string(formula.high);
        return '[' + std::to_string(formula.low) + ", " + high + ']';
    }

    const Model& model_;
    Index root_;
    std::unordered_map<Index, std::string> let_names_;
};

// ---- expressions --------------------------------------------------------------------------------

using ExprKind = Expr::Kind;
enum ExprLevel : int { kSum = 1, kProduct, kNegation, kPrimary };

void write(const Model& model, const Expr& expression, int weakest, std::string& out);

void write_call(const Model& model, const Expr& expression, std::string_view function,
                std::string& out) {
    out += function;
    out += '(';
    for (std::size_t i = 0; i < expression.arguments.size(); ++i) {
        if (i > 0) out += ", ";
        write(model, expression.arguments[i], kSum, out);
    }
    out += ')';
}

void write_binary(const Model& model, const Expr& expression, ExprLevel level,
                  std::string_view symbol, int weakest, std::string& out) {
    const bool parentheses = level < weakest;
    if (parentheses) out += '(';
    write(model, expression.arguments[0], level, out);
    out += symbol;
    write(model, expression.arguments[1], level + 1, out);
    if (parentheses) out += ')';
}

void write(const Model& model, const Expr& expression, int weakest, std::string& out) {
    switch (expression.kind) {
        case ExprKind::number: out += Decimal::parse(expression.text).text(); return;
        case ExprKind::scalar: out += model.inputs[expression.index].name; return;
        case ExprKind::distance: out += model.distances[expression.index].text; return;
        case ExprKind::negate:
            out += '-';
            write(model, expression.arguments[0], kNegation, out);
            return;
        case ExprKind::add: write_binary(model, expression, kSum, " + ", weakest, out); return;
        case ExprKind::subtract: write_binary(model, expression, kSum, " - ", weakest, out); return;
        case ExprKind::multiply:
            write_binary(model, expression, kProduct, " * ", weakest, out);
            return;
        case ExprKind::divide:
            write_binary(model, expression, kProduct, " / ", weakest, out);
            return;
        case ExprKind::abs: write_call(model, expression, "abs", out); return;
        case ExprKind::sqrt: write_call(model, expression, "sqrt", out); return;
        case ExprKind::min: write_call(model, expression, "min", out); return;
        case ExprKind::max: write_call(model, expression, "max", out); return;
    }
}

}  // namespace

bool lets_are_written_out(const Model& model, Index formula) {
    std::uint64_t size = 0;
    std::vector<Index> pending{formula};
    while (!pending.empty() && size <= kMaxPrinted) {
        const std::vector<Index>& operands = model.formulas[pending.back()].operands;
        pending.pop_back();
        pending.insert(pending.end(), operands.begin(), operands.end());
        ++size;
    }
    return pending.empty() && size <= kMaxPrinted;
}

std::string print(const Model& model, Index formula) {
    std::unordered_map<Index, std::string> let_names;
    if (!lets_are_written_out(model, formula))
        for (const Let& let : model.lets)
            if (let.formula != kNone) let_names.try_emplace(let.formula, let.name);
    return whole_text(formula, Phrases(model, formula, std::move(let_names)));
}

std::string shown(const Model& model, Index formula) {
    return elided_text(formula, Phrases(model, formula));
}

std::string print(const Model& model, const Expr& expression) {
    std::string out;
    write(model, expression, kSum, out);
    return out;
}

}  // namespace etlc::check
