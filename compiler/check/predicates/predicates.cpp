#include "check/predicates/predicates.hpp"

#include <fmt/format.h>

#include <cmath>

#include "check/context/context.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/numbers/decimal.hpp"
#include "check/numbers/range.hpp"

namespace etlc::check {

namespace {

using diag::Code;

std::optional<Threshold> literal_threshold(Context& c, const ast::Number& number) {
    const std::size_t errors = c.sink.errors();
    Threshold threshold;
    threshold.text = number.text;
    threshold.span = number.span;
    threshold.value64 = to_double(number.text);
    threshold.value = number32(c, number);
    return c.sink.errors() == errors ? std::optional(std::move(threshold)) : std::nullopt;
}

/// A distance is never negative, but a difference of two may be.
bool sign_fits(Context& c, const Expr& expression, const Threshold& threshold) {
    if (expression.kind != Expr::Kind::distance || !(threshold.range().low < 0))
        return true;  // also before calibration, when it is NaN
    const std::string negative = threshold.adaptation
                                     ? fmt::format("lo = {}", threshold.adaptation->lo)
                                     : fmt::format("the threshold {}", threshold.text);
    return c.refuse(Code::negative_threshold, threshold.span,
                    fmt::format("{} is negative, but distances never are", negative));
}

/// Returns a single number, with its sign.
std::optional<ast::Number> lone_number(const ast::Expr& written) {
    if (written.kind == ast::Expr::Kind::number)
        return ast::Number{written.text, written.span, written.constant};
    if (written.kind != ast::Expr::Kind::negate) return std::nullopt;
    auto number = lone_number(*written.arguments[0]);
    if (!number || number->text.starts_with('-')) return std::nullopt;
    number->text.insert(0, "-");
    number->span = written.span;
    if (!number->constant.empty()) number->constant.insert(0, "-");
    return number;
}

/// "x CMP y" with a number as y; if both change, it becomes x - y CMP 0.
struct Sides {
    std::optional<Expr> expression;  ///< empty after an error
    Comparison comparison;
    std::optional<Threshold> threshold;
};

Sides sides(Context& c, const ast::Expr& left, Comparison comparison, const ast::Expr& right) {
    if (const auto number = lone_number(right))
        return {check_expression(c, left), comparison, literal_threshold(c, *number)};
    if (const auto number = lone_number(left))
        return {check_expression(c, right), mirrored(comparison), literal_threshold(c, *number)};
    auto x = check_expression(c, left);
    auto y = check_expression(c, right);
    const Span span = source::join(left.span, right.span);
    Sides result{std::nullopt, comparison, literal_threshold(c, {"0", span})};
    if (!x || !y) return result;
    result.expression.emplace();
    result.expression->kind = Expr::Kind::subtract;
    result.expression->arguments = {std::move(*x), std::move(*y)};
    result.expression->span = span;
    return result;
}

/// Distances are rounded by their kernels, and means by their division, so exact equality means
/// nothing.
bool can_be_equal(Context& c, const Predicate& predicate) {
    std::string_view rounded;
    for_each(predicate.expression, [&](const Expr& e) {
        const bool is_mean =
            e.kind == Expr::Kind::past && c.model.pasts[e.index].kind == Past::Kind::mean;
        if (is_mean && rounded.empty()) rounded = "means";
        if (e.kind == Expr::Kind::distance) rounded = "distances";
    });
    if (!predicate.equality() || rounded.empty()) return true;
    return c.refuse(
        Code::equality_of_distances, predicate.span,
        fmt::format("'{}' compares {}, which are rounded; expected '<=', '<', '>=' or '>'",
                    symbol(predicate.comparison), rounded));
}

/// Returns the predicate, or nothing after an error.
std::optional<Predicate> make_predicate(Context& c, Sides sides, Span span) {
    auto& expression = sides.expression;
    auto& threshold = sides.threshold;
    if (!expression || !threshold || !sign_fits(c, *expression, *threshold)) return std::nullopt;
    Predicate predicate;
    predicate.comparison = sides.comparison;
    predicate.text =
        fmt::format("{} {} ", print(c.model, *expression), symbol(predicate.comparison));
    predicate.inputs = inputs_of(c.model, *expression);
    const Expr* undefined = nullptr;
    predicate.delta = range_of(c.model, *expression, undefined);
    if (undefined != nullptr)
        c.report(Code::never_defined, undefined->span,
                 fmt::format("'{}' {}, whatever the inputs are", print(c.model, *undefined),
                             undefined->kind == Expr::Kind::sqrt
                                 ? "is the square root of a negative number"
                                 : "divides by zero"));
    predicate.expression = std::move(*expression);
    predicate.threshold = std::move(*threshold);
    predicate.span = span;
    if (!can_be_equal(c, predicate)) return std::nullopt;
    return predicate;
}

Sides declared_sides(Context& c, const ast::Predicate& declaration) {
    const Comparison comparison = declaration.comparison;
    if (const auto* right = std::get_if<ast::ExprPtr>(&declaration.threshold))
        return sides(c, *declaration.expression, comparison, **right);
    const auto& calibrated = std::get<ast::Calibrated>(declaration.threshold);
    if (comparison == Comparison::equal || comparison == Comparison::not_equal) {
        c.report(Code::comparison_form, calibrated.span,
                 fmt::format("a calibrated threshold needs '<=', '<', '>=' or '>', found '{}'",
                             symbol(comparison)));
        return {std::nullopt, comparison, std::nullopt};
    }
    return {check_expression(c, *declaration.expression), comparison,
            check_calibrated(c, calibrated)};
}

/// Returns the range of epsilon - delta or delta - epsilon, or of the answer of an equality,
/// extended by the value for missing samples: a range of samples says nothing about a step without
/// one.
Range robustness_of(const Predicate& predicate) {
    if (std::isnan(predicate.threshold.value)) return kEverything;
    const Range epsilon = predicate.threshold.range();
    Range range = predicate.upper_bound() ? subtract(epsilon, predicate.delta)
                                          : subtract(predicate.delta, epsilon);
    if (predicate.equality()) {
        const auto answer = predicate.constant_answer();
        range = {answer == true ? kEverything.high : kEverything.low,
                 answer == false ? kEverything.low : kEverything.high};
    }
    if (predicate.missing)
        (*predicate.missing ? range.high : range.low) =
            *predicate.missing ? kEverything.high : kEverything.low;
    return range;
}

}  // namespace

Comparison mirrored(Comparison comparison) {
    switch (comparison) {
        case Comparison::less_equal: return Comparison::greater_equal;
        case Comparison::less: return Comparison::greater;
        case Comparison::greater_equal: return Comparison::less_equal;
        case Comparison::greater: return Comparison::less;
        case Comparison::equal:
        case Comparison::not_equal: break;
    }
    return comparison;
}

/// The answer of an ordering changes at most once along a range, so the ends have all answers.
std::optional<bool> Predicate::constant_answer() const {
    const Range epsilon = threshold.range();
    if (equality()) {
        const bool one_value = delta.low == delta.high && delta.low == epsilon.low;
        if (!one_value && delta.contains(epsilon.low)) return std::nullopt;
        return one_value == (comparison == Comparison::equal);
    }
    const bool answer = holds(comparison, delta.low, epsilon.low);
    for (const float value : {delta.low, delta.high})
        for (const float at : {epsilon.low, epsilon.high})
            if (holds(comparison, value, at) != answer) return std::nullopt;
    return answer;
}

Index comparison_predicate(Context& c, const ast::Formula& comparison) {
    auto predicate = make_predicate(
        c, sides(c, *comparison.left, comparison.comparison, *comparison.right), comparison.span);
    if (!predicate) return kNone;
    // Equal thresholds may be written differently.
    const std::string key = predicate->text + Decimal::parse(predicate->threshold.text).text();
    const auto [at, is_new] =
        c.predicate_of_text.try_emplace(key, static_cast<Index>(c.model.predicates.size()));
    if (is_new) c.model.predicates.push_back(std::move(*predicate));
    return at->second;
}

void check_predicates(Context& c) {
    for_each_declaration<ast::Predicate>(
        c.spec, [&](const ast::Predicate& declaration, Index index) {
            auto predicate = make_predicate(c, declared_sides(c, declaration), declaration.span);
            if (!predicate) c.scope.entity(NameKind::predicate, index).broken = true;
            c.model.predicates.push_back(predicate ? std::move(*predicate) : Predicate{});
            c.model.predicates.back().name = declaration.name.text;
            c.model.predicates.back().missing = declaration.missing;
        });
}

void set_robustness(Context& c) {
    for (Predicate& predicate : c.model.predicates) predicate.robustness = robustness_of(predicate);
}

}  // namespace etlc::check
