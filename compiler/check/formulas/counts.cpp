// Checks comparisons of a count, count(f, D) >= n: how often a formula began to hold within a time.
#include <fmt/format.h>

#include <algorithm>

#include "check/formulas/formulas.hpp"
#include "check/numbers/decimal.hpp"
#include "check/predicates/predicates.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using diag::Code;
using Kind = Formula::Kind;

/// A formula begins to hold at most at every second step.
std::uint32_t most_in(std::uint32_t steps) {
    return steps / 2 + steps % 2;
}

class CountCheck {
public:
    CountCheck(Context& context, const ast::Formula& written)
        : c_(context),
          written_(written),
          is_on_left_(is_count(*written.left)),
          count_(is_on_left_ ? *written.left : *written.right),
          other_(is_on_left_ ? *written.right : *written.left) {}

    Index run() {
        const auto steps = window();
        counted_ = check_formula(c_, *count_.past->formula);
        const auto number = steps ? whole_number(most_in(*steps)) : std::nullopt;
        if (!steps || !number || counted_ == kNone) return kNone;
        steps_ = *steps;
        most_ = most_in(*steps);
        return compared(*number);
    }

private:
    std::optional<std::uint32_t> window() {
        const ast::Bound& time = count_.past->time;
        if (!is_finite_duration(c_, time, "a count is over a finite time")) return std::nullopt;
        const auto steps = bound_steps(c_, time);
        if (!steps) return std::nullopt;
        if (*steps == 0)
            return c_.no_value(Code::past_form, time.span,
                               "a count over no step; expected at least one");
        if (*steps <= kMaxPast) return steps;
        return c_.no_value(Code::bound_too_large, time.span,
                           fmt::format("{} steps; a count looks back {} steps at most", *steps,
                                       std::uint32_t{kMaxPast}));
    }

    /// Returns the number on the other side, at most `most`.
    std::optional<std::uint32_t> whole_number(std::uint32_t most) {
        const bool is_number = other_.kind == ast::ExprKind::number;
        const auto whole = is_number ? Decimal::parse(other_.text).whole(kMaxPast) : std::nullopt;
        if (!whole)
            return c_.no_value(Code::past_form, other_.span,
                               "a count compares with a whole number, as in 'count(f, 60 s) >= 3'");
        if (*whole <= most) return static_cast<std::uint32_t>(*whole);
        return c_.no_value(Code::past_form, other_.span,
                           fmt::format("a formula begins to hold at most {} within {}; found {}",
                                       diag::counted(most, "time"),
                                       c_.file.text(count_.past->time.span), other_.text));
    }

    Comparison comparison() const {
        return is_on_left_ ? written_.comparison : mirrored(written_.comparison);
    }

    Index compared(std::uint32_t number) {
        switch (comparison()) {
            case Comparison::greater_equal: return at_least(number);
            case Comparison::greater: return at_least(number + 1);
            case Comparison::less: return negated(at_least(number));
            case Comparison::less_equal: return negated(at_least(number + 1));
            case Comparison::equal: return exactly(number);
            case Comparison::not_equal: break;
        }
        return negated(exactly(number));
    }

    Index at_least(std::uint32_t number) {
        if (number == 0 || number > most_) {
            c_.report(Code::past_form, written_.span,
                      fmt::format("a count within {} is a number from 0 to {}, so this comparison "
                                  "has the same answer at every step",
                                  c_.file.text(count_.past->time.span), most_));
            return kNone;
        }
        if (number > kMaxCount) {
            c_.report(
                Code::bound_too_large, other_.span,
                fmt::format("a count compares with at most {}; found {}", kMaxCount, other_.text));
            return kNone;
        }
        return add(
            {.kind = Kind::count, .index = number, .operands = {counted_}, .high = steps_ - 1});
    }

    Index exactly(std::uint32_t number) {
        if (number == 0) return negated(at_least(1));
        const Index enough = at_least(number);
        if (number == most_) return enough;
        const Index more = negated(at_least(number + 1));
        if (enough == kNone || more == kNone) return kNone;
        return add({.kind = Kind::conjunction, .operands = {enough, more}});
    }

    Index negated(Index formula) {
        return formula == kNone ? kNone : add({.kind = Kind::negation, .operands = {formula}});
    }

    Index add(Formula formula) {
        std::uint32_t depth = 0;
        for (const Index operand : formula.operands) depth = std::max(depth, c_.depths[operand]);
        formula.span = written_.span;
        return add_formula(c_, std::move(formula), count_.span, depth + 1);
    }

    Context& c_;
    const ast::Formula& written_;
    bool is_on_left_;
    const ast::Expr& count_;
    const ast::Expr& other_;
    Index counted_ = kNone;
    std::uint32_t steps_ = 0;
    std::uint32_t most_ = 0;
};

}  // namespace

bool is_count(const ast::Expr& expression) {
    return expression.kind == ast::ExprKind::past && expression.past->kind == ast::PastKind::count;
}

Index check_count(Context& context, const ast::Formula& comparison) {
    return CountCheck(context, comparison).run();
}

}  // namespace etlc::check
