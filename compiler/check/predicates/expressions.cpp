// Checks EXPR: scalars, numbers, aggregated distances and arithmetic.

#include <fmt/format.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "check/numbers/decimal.hpp"
#include "check/numbers/range.hpp"
#include "check/points/points.hpp"
#include "check/predicates/predicates.hpp"
#include "check/time/time.hpp"
#include "etlmon/distance/distances.hpp"

namespace etlc::check {

namespace {

using ast::ExprKind;
using diag::Code;

bool set_number(Context& c, Expr& result, const ast::Expr& written) {
    const std::size_t errors = c.sink.errors();
    result.text = written.text;
    result.number = to_double(written.text);
    result.number32 = number32(c, {written.text, written.span, written.constant});
    return c.sink.errors() == errors;
}

bool set_scalar(Context& c, Expr& result, const ast::Expr& written) {
    const ast::Name name{written.text, written.span};
    if (find(c, name, {NameKind::input, NameKind::constant}, "an input or a constant") == nullptr)
        return false;
    result.index = resolve(c, name, NameKind::input);
    if (result.index == kNone) return false;
    const Input& input = c.model.inputs[result.index];
    if (input.type == InputType::scalar) return true;
    auto& error = c.report(Code::operand_not_scalar, written.span,
                           fmt::format("'{}' is {}; expected a scalar", written.text,
                                       input.is_embedding() ? "an embedding" : "a bool"));
    if (input.is_embedding())
        error.note(
            fmt::format("a distance turns it into a number: min l2({}, TARGET)", written.text));
    if (!input.is_embedding()) error.note("a bool is a formula by itself; compare two with '<->'");
    return false;
}

std::optional<Expr> build(Context& c, const ast::Expr& written) {
    Expr result;
    result.kind = written.kind;
    result.span = written.span;
    bool good = true;
    if (result.kind == ExprKind::number) good = set_number(c, result, written);
    if (result.kind == ExprKind::scalar) good = set_scalar(c, result, written);
    if (result.kind == ExprKind::distance) {
        result.index = check_distance(c, *written.distance);
        good = result.index != kNone;
    }
    if (result.kind == ExprKind::past) return check_past(c, written);
    for (const ast::ExprPtr& argument : written.arguments) {
        auto built = build(c, *argument);
        if (built) result.arguments.push_back(std::move(*built));
        good = good && built.has_value();
    }
    return good ? std::optional(std::move(result)) : std::nullopt;
}

bool is_zero(const Range& range) {
    return range.low == 0 && range.high == 0;
}

}  // namespace

std::optional<Expr> check_expression(Context& context, const ast::Expr& expression) {
    return build(context, expression);
}

namespace {

/// Returns the range of a distance: [0, 2] for cosine, [0, pi] for angular, [0, inf] for others.
Range range_of(Metric metric) {
    switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case Metric::id:                                  \
        return {0.0F, etlmon::Type::kHighest};
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
    return {0.0F, std::numeric_limits<float>::infinity()};
}

}  // namespace

Range range_of(const Model& model, const Expr& expression, const Expr*& undefined) {
    std::vector<Range> arguments;
    for (const Expr& argument : expression.arguments)
        arguments.push_back(range_of(model, argument, undefined));
    switch (expression.kind) {
        case ExprKind::number: return {expression.number32, expression.number32};
        case ExprKind::scalar: return model.inputs[expression.index].range;
        case ExprKind::distance: return range_of(model.distances[expression.index].metric);
        case ExprKind::past: return model.pasts[expression.index].range;
        case ExprKind::negate: return negate(arguments[0]);
        case ExprKind::add: return add(arguments[0], arguments[1]);
        case ExprKind::subtract: return subtract(arguments[0], arguments[1]);
        case ExprKind::multiply: return multiply(arguments[0], arguments[1]);
        case ExprKind::divide:
            if (is_zero(arguments[1])) undefined = &expression;
            return divide(arguments[0], arguments[1]);
        case ExprKind::abs: return abs(arguments[0]);
        case ExprKind::sqrt:
            if (arguments[0].high < 0) undefined = &expression;
            return sqrt(arguments[0]);
        case ExprKind::min: return min(arguments);
        case ExprKind::max: return max(arguments);
    }
    return kEverything;
}

std::vector<Index> inputs_of(const Model& model, const Expr& expression) {
    std::set<Index> inputs;
    for_each(expression, [&](const Expr& e) {
        if (e.kind == ExprKind::scalar) inputs.insert(e.index);
    });
    for_each_distance(expression, [&](Index distance) {
        const Distance& measured = model.distances[distance];
        for (const Index point : {measured.point, measured.other}) {
            if (point == kNone) continue;
            const std::vector<Index>& of = model.points[point].inputs;
            inputs.insert(of.begin(), of.end());
        }
    });
    return {inputs.begin(), inputs.end()};
}

// Checks numbers that earlier steps have a part in: EXPR@3s, mean(EXPR, 2s), min and max of
// windows.

namespace {

using ast::PastKind;

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
        case PastKind::count:
        case PastKind::fraction: break;
    }
    return {
        since, ever,
        fmt::format("'fraction({}, {}) >= 0.8': it held at that share of the steps", name, time),
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
    if (written.past->formula != nullptr)
        return c.no_value(
            Code::past_form, written.span,
            fmt::format("a {} stands alone on one side of a comparison in a formula, as in '{}'",
                        word(past.kind),
                        past.kind == PastKind::count ? "let often = count(f, 60 s) >= 3;"
                                                     : "let mostly = fraction(f, 5 s) >= 0.8;"));
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
