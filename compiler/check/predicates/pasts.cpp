// Checks numbers that earlier steps have a part in: EXPR@3s, mean(EXPR, 2s), min and max of
// windows.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "check/numbers/decimal.hpp"
#include "check/points/points.hpp"
#include "check/predicates/predicates.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using ast::ExprKind;
using ast::PastKind;
using diag::Code;

std::nullopt_t report_too_long(Context& c, Span span, std::uint64_t steps) {
    return c.no_value(Code::bound_too_large, span,
                      fmt::format("{} steps; a number looks back {} steps at most", steps,
                                  std::uint32_t{kMaxPast}));
}

/// Returns the length of a window in steps, from 1 on; nothing after an error.
std::optional<std::uint32_t> window_steps(Context& c, PastKind kind, const ast::Bound& time) {
    if (time.unit.empty()) {
        const std::string number =
            time.number.constant.empty() ? time.number.text : time.number.constant;
        auto& error = c.report(
            Code::past_form, time.span,
            fmt::format("the time of a {} needs a unit; write '{} steps', or a duration: '{} s'",
                        word(kind), number, number));
        error.meant = number + " steps";
        return std::nullopt;
    }
    const auto steps = bound_steps(c, time);
    if (!steps) return std::nullopt;
    if (*steps == 0)
        return c.no_value(Code::past_form, time.span,
                          fmt::format("a {} over no step; expected at least one", word(kind)));
    if (*steps > kMaxPast) return report_too_long(c, time.span, *steps);
    return steps;
}

/// Returns EXPR of EXPR@1s@2s, and adds the delays.
const ast::Expr* undelayed(Context& c, const ast::Expr& written, std::uint64_t& steps) {
    const ast::Expr* at = &written;
    while (at->kind == ExprKind::past && at->past->kind == PastKind::ago) {
        const auto more = steps_ago(c, at->past->time);
        if (!more) return nullptr;
        steps += *more;
        at = at->arguments[0].get();
    }
    return at;
}

/// Returns notes with the formulas that may be meant where the past of a truth value is asked for.
std::vector<std::string> instead(const std::string& name, PastKind kind, const std::string& time) {
    const std::string since = fmt::format("'held[{}] {}': it has held for {}", time, name, time);
    const std::string ever = fmt::format("'O[0, {}] {}': it held at some step", time, name);
    switch (kind) {
        case PastKind::ago:
            return {fmt::format("whether it held then is 'O[{0}, {0}] {1}'", time, name)};
        case PastKind::min: return {since};
        case PastKind::max: return {ever};
        case PastKind::mean:
        case PastKind::count: break;
    }
    return {since, ever,
            fmt::format("'count({}, {}) >= 3': it began to hold three times or more", name, time)};
}

/// Refuses a predicate, let or bool where a number is expected, and names formulas that may be
/// meant.
bool is_number(Context& c, const ast::Expr& of, const ast::Past& past) {
    const Reference* const found = of.kind == ExprKind::name ? c.scope.find(of.text) : nullptr;
    if (found == nullptr) return true;
    const bool is_bool =
        found->kind == NameKind::input && c.model.inputs[found->index].type == InputType::boolean;
    if (found->kind != NameKind::predicate && found->kind != NameKind::let && !is_bool) return true;
    Entity& entity = c.scope.entity(*found);
    entity.used = true;
    if (entity.broken) return true;  // reported already
    std::string time{c.file.text(past.time.span)};
    if (past.time.unit.empty() && past.time.number.constant.empty())
        time += past.time.number.text == "1" ? " step" : " steps";
    auto& error =
        c.report(Code::operand_not_scalar, of.span,
                 fmt::format("'{}' is {}, a truth value; '{}' takes a number", of.text,
                             is_bool ? "a bool" : word_with_article(found->kind), word(past.kind)));
    for (std::string& note : instead(of.text, past.kind, time)) error.note(std::move(note));
    return false;
}

/// The unit tells min(x, 20 steps) from min(x, 20).
std::string text_of(const Model& model, const Past& past) {
    const std::string of = print(model, past.expression);
    if (past.kind != PastKind::ago)
        return fmt::format("{}({}, {} {})", word(past.kind), of, past.steps, ast::kStepsUnit);
    const bool whole = ast::operator_of(past.expression.kind).level == ast::kPrimary;
    return whole ? fmt::format("{}@{}", of, past.steps) : fmt::format("({})@{}", of, past.steps);
}

Expr added(Context& c, Past past) {
    const Expr* undefined = nullptr;
    past.text = text_of(c.model, past);
    past.range = range_of(c.model, past.expression, undefined);
    Expr result;
    result.kind = ExprKind::past;
    result.span = past.span;
    result.arguments.push_back(past.expression);
    const auto [at, is_new] =
        c.past_of_text.try_emplace(past.text, static_cast<Index>(c.model.pasts.size()));
    result.index = at->second;
    if (is_new) c.model.pasts.push_back(std::move(past));
    return result;
}

}  // namespace

std::optional<Expr> check_past(Context& c, const ast::Expr& written) {
    Past past;
    past.kind = written.past->kind;
    past.span = written.span;
    if (past.kind == PastKind::count)
        return c.no_value(Code::past_form, written.span,
                          "a count stands alone on one side of a comparison in a formula, as in "
                          "'let often = count(f, 60 s) >= 3;'");
    std::uint64_t steps = 0;
    const ast::Expr* of = written.arguments[0].get();
    if (past.kind == PastKind::ago) {
        of = undelayed(c, written, steps);
    } else if (const auto length = window_steps(c, past.kind, written.past->time)) {
        steps = *length;
    }
    if (of == nullptr || !is_number(c, *of, *written.past)) return std::nullopt;
    auto expression = check_expression(c, *of);
    if (!expression || steps == 0) return std::nullopt;
    if (steps > kMaxPast) return report_too_long(c, written.span, steps);
    // A window of one step holds the number itself.
    if (past.kind != PastKind::ago && steps == 1) return expression;
    past.expression = std::move(*expression);
    past.steps = static_cast<std::uint32_t>(steps);
    return added(c, std::move(past));
}

}  // namespace etlc::check
