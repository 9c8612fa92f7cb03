#include "check/formulas/formulas.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/context/context.hpp"
#include "check/predicates/predicates.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using diag::Code;
using Kind = Formula::Kind;

/// Constants and operators have the same numbers in the syntax tree and in the model.
Kind kind_of(ast::Formula::Kind written) {
    static_assert(static_cast<int>(Kind::negation) ==
                  static_cast<int>(ast::Formula::Kind::negation));
    return static_cast<Kind>(written);
}

class FormulaCheck {
public:
    explicit FormulaCheck(Context& context) : c_(context) {}

    Index build(const ast::Formula& written) {
        if (written.kind == ast::Formula::Kind::name) return named(written);
        if (written.kind == ast::Formula::Kind::comparison) {
            if (is_count(*written.left) || is_count(*written.right)) return counted(written);
            return leaf(Kind::predicate, comparison_predicate(c_, written), written);
        }
        Formula formula;
        formula.kind = kind_of(written.kind);
        formula.span = written.span;
        bool good = set_interval(formula, written);
        std::uint32_t depth = 0;
        for (const ast::FormulaPtr& operand : written.operands) {
            const Index index = build(*operand);
            formula.operands.push_back(index);
            if (index == kNone)
                good = false;
            else
                depth = std::max(depth, c_.depths[index]);
        }
        if (!good) return kNone;
        if (is_too_deep(depth, written)) return kNone;
        return add_formula(c_, std::move(formula), written.operator_span, depth + 1);
    }

private:
    bool is_too_deep(std::uint32_t depth, const ast::Formula& written) {
        if (depth < kMaxDepth) return false;
        c_.report(
            Code::formula_too_deep, written.span,
            fmt::format("a formula of more than {} levels with its lets written out", kMaxDepth));
        return true;
    }

    Index counted(const ast::Formula& written) {
        const Index index = check_count(c_, written);
        return index == kNone || is_too_deep(c_.depths[index] - 1, written) ? kNone : index;
    }

    /// Adds an atom; kNone for kNone.
    Index leaf(Kind kind, Index index, const ast::Formula& written) {
        if (index == kNone) return kNone;
        Formula formula;
        formula.kind = kind;
        formula.index = index;
        formula.span = written.span;
        return add_formula(c_, std::move(formula), written.span, 1);
    }

    bool set_interval(Formula& formula, const ast::Formula& written) {
        if (looks_one_step_away(formula.kind)) formula.low = formula.high = 1;
        if (!written.interval) return true;
        if (formula.kind == Kind::held &&
            !is_finite_duration(c_, written.interval->high, "a formula is held for a finite time",
                                "for what has held since the first step, write 'H f'"))
            return false;
        const auto steps = interval_steps(c_, *written.interval);
        if (!steps) return false;
        formula.low = steps->low;
        formula.high = steps->high;
        return true;
    }

    Index named(const ast::Formula& written) {
        const ast::Name name{written.name, written.span};
        const Reference* found =
            find(c_, name, {NameKind::predicate, NameKind::let, NameKind::input},
                 "a predicate, a let or a bool input");
        if (found == nullptr || found->kind == NameKind::unreadable) return kNone;
        const Entity& entity = c_.scope.entity(*found);
        if (found->kind == NameKind::predicate)
            return entity.broken ? kNone : leaf(Kind::predicate, found->index, written);
        if (found->kind == NameKind::let)
            return entity.broken ? kNone : c_.model.lets[found->index].formula;
        if (found->kind == NameKind::input)
            return entity.broken ? kNone : input(found->index, written);
        auto& error =
            c_.report(Code::wrong_kind, written.span,
                      fmt::format("'{}' is {}; expected a predicate, a let or a bool input",
                                  written.name, word_with_article(found->kind)));
        error.note(entity.span, fmt::format("'{}' is declared here", written.name));
        if (found->kind == NameKind::monitor)
            error.note("use let to name a formula that is used more than once");
        if (found->kind == NameKind::target)
            error.note(fmt::format(
                "a predicate measures a distance to it: min l2(INPUT, {}) <= 0.5", written.name));
        return kNone;
    }

    Index input(Index index, const ast::Formula& written) {
        const Input& input = c_.model.inputs[index];
        if (input.type == InputType::boolean) return leaf(Kind::boolean_input, index, written);
        auto& error =
            c_.report(Code::not_a_formula, written.span,
                      fmt::format("'{}' is {}, which is neither true nor false", written.name,
                                  input.is_embedding() ? "an embedding" : "a scalar"));
        error.note(input.is_embedding()
                       ? fmt::format("compare its distance to a target: min l2({}, TARGET) <= 0.5",
                                     written.name)
                       : fmt::format("compare it with a number: {} > 0.5", written.name));
        return kNone;
    }

    Context& c_;
};

}  // namespace

Index add_formula(Context& c, Formula formula, Span operator_span, std::uint32_t depth) {
    c.model.formulas.push_back(std::move(formula));
    c.operator_spans.push_back(operator_span);
    c.depths.push_back(depth);
    return static_cast<Index>(c.model.formulas.size() - 1);
}

Index check_formula(Context& context, const ast::Formula& formula) {
    return FormulaCheck(context).build(formula);
}

}  // namespace etlc::check
