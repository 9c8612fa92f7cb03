#include "check/predicates/predicates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "check/context/context.hpp"
#include "check/encoders/encoded.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/matrices/matrices.hpp"
#include "check/numbers/decimal.hpp"
#include "check/numbers/range.hpp"
#include "check/points/points.hpp"
#include "data/arrays/array.hpp"

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

// Checks target sets.

namespace {

std::optional<Matrix> rows_of(Context& c, const ast::Target::Source& source,
                              const ast::Target& target) {
    if (is_encoded(source)) return read_encoded(c, source, target.encoder);
    if (const auto* load = std::get_if<ast::Load>(&source)) return read_matrix(c, *load);
    if (const auto* literal = std::get_if<ast::MatrixLiteral>(&source))
        return read_matrix(c, *literal);
    if (const auto* frames = std::get_if<ast::Frames>(&source)) return read_frames(c, *frames);
    const auto& vector = std::get<ast::VectorLiteral>(source);
    const std::string words{c.file.text(vector.span)};
    c.report(Code::target_is_vector, vector.span,
             "a target is a set of embeddings, one per row: expected a matrix, found a vector")
        .note(words.size() <= 60 ? fmt::format("for a set of one embedding write [{}]", words)
                                 : "for a set of one embedding add another pair of brackets");
    return std::nullopt;
}

/// Appends rows from another source.
bool append(Context& c, Matrix& all, Matrix rows, Span span) {
    if (rows.columns != all.columns)
        return c.refuse(Code::dimension_mismatch, span,
                        fmt::format("these rows have dimension {}, those before them {}",
                                    rows.columns, all.columns));
    if (rows.rows > std::numeric_limits<std::uint32_t>::max() - all.rows)
        return c.refuse(Code::matrix_shape, span,
                        fmt::format("a target of more than {} rows",
                                    std::numeric_limits<std::uint32_t>::max()));
    for (EncodedRows of : rows.encoded) {
        of.first += all.rows;
        all.encoded.push_back(of);
    }
    all.rows += rows.rows;
    all.values.insert(all.values.end(), rows.values.begin(), rows.values.end());
    all.origin += ", " + rows.origin;
    if (all.path.empty()) all.path = std::move(rows.path);
    all.hash = data::content_hash({all.rows, all.columns}, all.values);
    return true;
}

bool set_rows(Context& c, const ast::Target& declaration, Target& target) {
    std::optional<Matrix> all;
    bool good = true;
    for (const ast::Target::Source& source : declaration.sources) {
        auto rows = rows_of(c, source, declaration);
        if (!rows)
            good = false;
        else if (!all)
            all = std::move(rows);
        else
            good = append(c, *all, std::move(*rows), span_of(source)) && good;
    }
    if (!good) return false;
    target.rows = all->rows;
    target.dimension = all->columns;
    target.values = std::move(all->values);
    target.origin = std::move(all->origin);
    target.path = std::move(all->path);
    target.hash = std::move(all->hash);
    target.encoded = std::move(all->encoded);
    return true;
}

/// Returns the encoder of the rows; kNone where it is not known, as of rows from a file.
Index encoder_of(Context& c, const ast::Target& declaration, const ast::Target::Source& source) {
    const auto* const frames = std::get_if<ast::Frames>(&source);
    const bool is_image = is_encoded(source);
    if (!is_image && frames == nullptr) return kNone;
    const Reference* const by = c.scope.find(is_image ? declaration.encoder->text : frames->key);
    if (by == nullptr) return kNone;
    if (by->kind == NameKind::encoder) return is_image ? by->index : kNone;
    return by->kind == NameKind::input && !is_image ? c.model.inputs[by->index].encoder : kNone;
}

/// Whether all rows are by one encoder, as far as it is known, and `by NAME` is about some of them.
bool set_encoder(Context& c, const ast::Target& declaration, Index target) {
    Index of_rows = kNone;
    for (const ast::Target::Source& source : declaration.sources) {
        const Index one = encoder_of(c, declaration, source);
        if (one == kNone) continue;
        if (of_rows != kNone && of_rows != one)
            return c.refuse(Code::wrong_space, span_of(source),
                            fmt::format("these rows of '{}' are by {}, those before them by {}",
                                        declaration.name.text, c.model.encoders[one].name,
                                        c.model.encoders[of_rows].name));
        of_rows = one;
    }
    if (of_rows != kNone) c.encoder_of_target[target] = of_rows;
    const bool is_needed = std::any_of(declaration.sources.begin(), declaration.sources.end(),
                                       [](const auto& source) { return is_encoded(source); });
    if (is_needed || !declaration.encoder) return true;
    return c.refuse(Code::encoder_use, declaration.encoder->span,
                    fmt::format("no row of '{}' is made of an image or video, so that 'by {}' says "
                                "nothing; leave it out",
                                declaration.name.text, declaration.encoder->text));
}

/// `of P(z)`: the rows are in the space of P(z) already.
bool set_space(Context& c, const ast::Point& written, Target& target) {
    const Index index = check_point(c, written);
    if (index == kNone) return false;
    const Index space = space_of(c, index);
    c.point_of_target[static_cast<Index>(c.model.targets.size())] = space;
    const Point& point = c.model.points[space];
    if (point.is_projected()) target.space = space;
    if (point.dimension == target.dimension) return true;
    return c.refuse(Code::dimension_mismatch, written.span,
                    fmt::format("{} has dimension {}, the rows of '{}' have {}", point.text,
                                point.dimension, target.name, target.dimension));
}

bool set_fitted(Context& c, const ast::Fitted& written, Target& target) {
    const auto index = static_cast<Index>(c.model.targets.size());
    target.fitted = check_fitted(c, written, Fitted::Slot::target, target.name, index);
    if (target.fitted == kNone) return false;
    const Fitted& fitted = c.model.fitted[target.fitted];
    target.rows = fitted.rows;
    target.dimension = fitted.columns;
    target.origin = "fitted";
    if (const fitted::Entry* const entry = fitted_entry(c, target.fitted)) {
        target.values = entry->matrix;
        target.hash = entry->hash;
    }
    const Index space = space_of(c, fitted.point);
    c.point_of_target[index] = space;
    if (c.model.points[space].is_projected()) target.space = space;
    return true;
}

}  // namespace

void check_targets(Context& c) {
    for_each_declaration<ast::Target>(c.spec, [&](const ast::Target& declaration, Index index) {
        Target target;
        target.name = declaration.name.text;
        target.span = declaration.name.span;
        const auto* const fitted = std::get_if<ast::Fitted>(&declaration.sources[0]);
        bool good =
            fitted != nullptr ? set_fitted(c, *fitted, target) : set_rows(c, declaration, target);
        good = good && (fitted != nullptr || set_encoder(c, declaration, index));
        good = good && (!declaration.space || set_space(c, *declaration.space, target));
        if (!good) c.scope.entity(NameKind::target, index).broken = true;
        c.model.targets.push_back(std::move(target));
    });
}

}  // namespace etlc::check
