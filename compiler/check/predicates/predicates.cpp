#include "check/predicates/predicates.hpp"

#include <fmt/format.h>

#include <cmath>

#include "check/guarantees/calibrated.hpp"
#include "check/numbers/decimal.hpp"
#include "check/numbers/range_arithmetic.hpp"
#include "check/predicates/expressions.hpp"
#include "check/steps.hpp"

namespace etlc::check {

namespace {

using diag::Code;

Comparison comparison_of(ast::Comparison comparison) {
    switch (comparison) {
        case ast::Comparison::less_equal: return Comparison::less_equal;
        case ast::Comparison::less: return Comparison::less;
        case ast::Comparison::greater_equal: return Comparison::greater_equal;
        case ast::Comparison::greater: return Comparison::greater;
    }
    return Comparison::less_equal;
}

std::optional<Threshold> literal_threshold(Context& c, const ast::Number& number) {
    const std::size_t errors = c.sink.errors();
    Threshold threshold;
    threshold.text = number.text;
    threshold.span = number.span;
    threshold.value64 = to_double(number.text);
    threshold.value = number32(c, number);
    return c.sink.errors() == errors ? std::optional(std::move(threshold)) : std::nullopt;
}

/// A distance is never below zero. In a difference of two a negative threshold has its sense.
bool sign_fits(Context& c, const Expr& expression, const Threshold& threshold) {
    const bool negative = threshold.range().low < 0;  // not known of one that is not yet calibrated
    if (expression.kind != Expr::Kind::distance || !negative) return true;
    if (threshold.adaptation)
        c.report(Code::negative_threshold, threshold.span,
                 fmt::format("lo = {} is below every distance, which is never negative",
                             threshold.adaptation->lo));
    else
        c.report(
            Code::negative_threshold, threshold.span,
            fmt::format("the threshold {} on a distance, which is never negative", threshold.text));
    return false;
}

/// The predicate, or nothing where it had an error. `threshold` is absent where that had one.
std::optional<Predicate> make_predicate(Context& c, const ast::Expr& written,
                                        ast::Comparison comparison,
                                        std::optional<Threshold> threshold, Span span) {
    auto expression = check_expression(c, written);
    if (!expression || !threshold || !sign_fits(c, *expression, *threshold)) return std::nullopt;
    Predicate predicate;
    predicate.comparison = comparison_of(comparison);
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
    return predicate;
}

std::optional<Threshold> declared_threshold(Context& c, const ast::Predicate& declaration) {
    if (const auto* number = std::get_if<ast::Number>(&declaration.threshold))
        return literal_threshold(c, *number);
    return check_calibrated(c, std::get<ast::Calibrated>(declaration.threshold));
}

/// epsilon - delta or delta - epsilon; and -inf or +inf, where a missing sample counts as that.
Range robustness_of(const Predicate& predicate) {
    if (std::isnan(predicate.threshold.value)) return kEverything;
    const Range epsilon = predicate.threshold.range();
    Range range = predicate.upper_bound() ? subtract(epsilon, predicate.delta)
                                          : subtract(predicate.delta, epsilon);
    if (predicate.missing)
        (*predicate.missing ? range.high : range.low) =
            *predicate.missing ? kEverything.high : kEverything.low;
    return range;
}

}  // namespace

std::string_view symbol(Comparison comparison) {
    switch (comparison) {
        case Comparison::less_equal: return "<=";
        case Comparison::less: return "<";
        case Comparison::greater_equal: return ">=";
        case Comparison::greater: return ">";
    }
    return "";
}

Index comparison_predicate(Context& c, const ast::Formula& comparison) {
    auto predicate = make_predicate(c, *comparison.left, comparison.comparison,
                                    literal_threshold(c, comparison.right), comparison.span);
    if (!predicate) return kNone;
    // Equal numbers may be written differently, and the text of the threshold is as written.
    const std::string key = predicate->text + Decimal::parse(comparison.right.text).text();
    const auto [at, is_new] =
        c.predicate_of_text.try_emplace(key, static_cast<Index>(c.model.predicates.size()));
    if (is_new) c.model.predicates.push_back(std::move(*predicate));
    return at->second;
}

void check_predicates(Context& c) {
    for_each_declaration<ast::Predicate>(
        c.spec, [&](const ast::Predicate& declaration, Index index) {
            auto predicate = make_predicate(c, *declaration.expression, declaration.comparison,
                                            declared_threshold(c, declaration), declaration.span);
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
