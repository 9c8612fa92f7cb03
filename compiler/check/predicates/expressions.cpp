// Checks EXPR: scalars, numbers, aggregated distances and arithmetic. Numbers that earlier steps
// have a part in are checked in pasts.cpp.
#include "check/predicates/predicates.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "check/numbers/decimal.hpp"
#include "check/numbers/range.hpp"
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

}  // namespace etlc::check
