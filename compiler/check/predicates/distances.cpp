// Checks AGG DIST(point, target).

#include "check/predicates/distances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "check/matrices/matrices.hpp"
#include "check/numbers/decimal.hpp"
#include "check/points/points.hpp"
#include "check/predicates/predicates.hpp"

namespace etlc::check {

namespace {

using diag::Code;

class DistanceCheck {
public:
    DistanceCheck(Context& context, const ast::Distance& written)
        : c_(context), written_(written) {}

    Index run() {
        set_metric();
        distance_.point = check_point(c_, written_.point);
        if (!is_to_target()) return between_points();
        distance_.target = resolve(c_, written_.other.name, NameKind::target);
        const bool point = distance_.point != kNone;
        const bool target = distance_.target != kNone;
        bool fits = point && target && set_space();
        if (target) fits = set_aggregation() && fits;
        if (target) fits = rows_have_directions() && fits;
        if (point) fits = set_weights() && fits;
        return fits ? add() : kNone;
    }

private:
    /// A name is that of a target unless it is an input.
    bool is_to_target() const {
        if (!written_.other.is_name()) return false;
        const Reference* const meant = c_.scope.find(written_.other.name.text);
        return meant == nullptr || meant->kind != NameKind::input;
    }

    Index between_points() {
        distance_.other = check_point(c_, written_.other);
        if (distance_.point == kNone || distance_.other == kNone) return kNone;
        const bool fits = has_no_aggregation() &&
                          check_same_space(c_, distance_.point, distance_.other, both_points()) &&
                          set_weights();
        return fits ? add() : kNone;
    }

    bool has_no_aggregation() {
        if (!written_.aggregation) return true;
        return c_.refuse(Code::point_form, written_.aggregation->span,
                         fmt::format("the distance between two points is one number; expected {} "
                                     "without {}, or a target",
                                     written_.metric.text, word(written_.aggregation->kind)));
    }

    bool encoders_of_rows_fit() {
        const Index space = space_of(c_, distance_.point);
        const std::vector<Index>& inputs = c_.model.points[space].inputs;
        const auto rows = c_.encoder_of_target.find(distance_.target);
        if (rows != c_.encoder_of_target.end() && inputs.size() == 1 &&
            !is_by(c_, c_.model.inputs[inputs[0]], rows->second, target().name, both_points()))
            return false;
        const auto of = c_.point_of_target.find(distance_.target);
        return of == c_.point_of_target.end() ||
               encoders_fit(c_, distance_.point, of->second, both_points());
    }

    Span both_points() const { return source::join(written_.point.span, written_.other.span); }

    void set_metric() {
        const auto* const found =
            std::find_if(kMetrics.begin(), kMetrics.end(),
                         [&](const MetricRow& row) { return row.word == written_.metric.text; });
        assert(found != kMetrics.end());  // the grammar has no other
        distance_.metric = static_cast<Metric>(found - kMetrics.begin());
    }

    std::uint32_t dimension() const { return c_.model.points[distance_.point].dimension; }

    const Target& target() const { return c_.model.targets[distance_.target]; }

    /// Uses the target's rows in the space of the point.
    bool set_space() {
        if (!encoders_of_rows_fit()) return false;
        const Index there = target_in_space(c_, distance_.target, distance_.point, both_points());
        if (there != kNone) distance_.target = there;
        return there != kNone;
    }

    bool set_aggregation() {
        if (!written_.aggregation) {
            if (target().rows == 1) return true;
            c_.report(Code::aggregation_missing, written_.metric.span,
                      fmt::format(
                          "target '{}' has {} rows; expected min, max, mean or kth(n) before {}",
                          target().name, target().rows, written_.metric.text))
                .note(fmt::format("the distance to the nearest row is 'min {}(...)'",
                                  written_.metric.text));
            return false;
        }
        distance_.aggregation = written_.aggregation->kind;
        return distance_.aggregation != Aggregation::kth || set_kth();
    }

    bool set_kth() {
        const ast::Number& rank = *written_.aggregation->n;
        const auto n = Decimal::parse(rank.text).whole(target().rows);
        if (n && *n > 0) {
            distance_.kth = static_cast<std::uint32_t>(*n);
            return true;
        }
        return c_.refuse(
            Code::kth_out_of_range, written_.aggregation->span,
            fmt::format("kth({}) of target '{}'; expected a whole number from 1 to its {}",
                        shown(rank), target().name, diag::counted(target().rows, "row")));
    }

    /// cosine and angular compare directions, which a zero vector lacks.
    bool rows_have_directions() {
        if (!is_of_directions(distance_.metric) || target().values.empty()) return true;
        const std::size_t columns = target().dimension;
        for (std::size_t row = 0; row < target().rows; ++row) {
            const auto begin = target().values.begin() + static_cast<std::ptrdiff_t>(row * columns);
            if (!std::all_of(begin, begin + static_cast<std::ptrdiff_t>(columns),
                             [](float x) { return x == 0; }))
                continue;
            c_.report(
                  Code::zero_row, written_.other.span,
                  fmt::format("row {} (from 0) of target '{}' is zero, and {} needs a direction",
                              row, target().name, written_.metric.text))
                .note(target().span, fmt::format("'{}' is declared here", target().name));
            return false;
        }
        return true;
    }

    bool set_weights() {
        if (!written_.weights) return true;
        auto weights = check_weights(c_, *written_.weights, distance_.point, written_.metric.span);
        if (!weights) return false;
        distance_.weights = std::move(weights->values);
        distance_.weights_diagonal = weights->diagonal;
        distance_.weights_path = std::move(weights->path);
        distance_.weights_fitted = weights->fitted;
        weights_text_ = std::move(weights->text);
        return true;
    }

    /// With a single row every aggregation is the distance itself, so the text has none.
    std::string canonical_text() {
        std::string text;
        if (distance_.is_between_points() || target().rows == 1) {
            distance_.aggregation = Aggregation::min;
            distance_.kth = 1;
        } else {
            text = word(distance_.aggregation);
            if (distance_.aggregation == Aggregation::kth)
                text += fmt::format("({})", distance_.kth);
            text += ' ';
        }
        text += written_.metric.text;
        if (written_.weights) text += fmt::format("({})", weights_text_);
        const std::string& other =
            distance_.is_between_points() ? c_.model.points[distance_.other].text : target().name;
        return text + fmt::format("({}, {})", c_.model.points[distance_.point].text, other);
    }

    Index add() {
        distance_.text = canonical_text();
        distance_.span = written_.span;
        const auto [at, is_new] = c_.distance_of_text.try_emplace(
            distance_.text, static_cast<Index>(c_.model.distances.size()));
        if (is_new) c_.model.distances.push_back(std::move(distance_));
        return at->second;
    }

    Context& c_;
    const ast::Distance& written_;
    Distance distance_;
    std::string weights_text_;
};

}  // namespace

Index check_distance(Context& context, const ast::Distance& distance) {
    return DistanceCheck(context, distance).run();
}

namespace {

/// Limit on |W_ij - W_ji| relative to sqrt(W_ii W_jj): symmetric matrices in float32 files differ
/// by rounding. The weights are the mean of both.
constexpr double kSymmetryTolerance = 1e-5;

/// A smaller pivot, relative to its diagonal element, is a rounding error of the elimination.
constexpr double kPivotTolerance = 1e-12;
/// Longer literals appear in canonical text as hashes.
constexpr std::size_t kMaxSpelledOut = 16;

std::string literal_text(const Matrix& matrix, const std::vector<std::vector<ast::Number>>& rows,
                         bool brackets) {
    if (matrix.values.size() > kMaxSpelledOut)
        return fmt::format("literal {} x {} {}", matrix.rows, matrix.columns, matrix.hash);
    std::string text = brackets ? "[" : "";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        text += i > 0 ? ", [" : "[";
        for (std::size_t j = 0; j < rows[i].size(); ++j)
            text += (j > 0 ? ", " : "") + Decimal::parse(rows[i][j].text).text();
        text += ']';
    }
    return brackets ? text + ']' : text;
}

struct Source {
    Matrix matrix;
    std::string text;
};

std::optional<Source> read_source(Context& c, const ast::Weights& weights) {
    if (const auto* name = std::get_if<ast::Name>(&weights)) {
        const Index index = resolve(c, *name, NameKind::target);
        if (index == kNone) return std::nullopt;
        const Target& target = c.model.targets[index];
        if (target.fitted != kNone)
            return c.no_value(
                Code::fitting_argument, name->span,
                fmt::format("the rows of '{}' are fitted and cannot be weights; expected a "
                            "matrix, or fitted(discriminant, of = POINT, where = FORMULA)",
                            name->text));
        Matrix matrix{target.rows,   target.dimension, false,      target.values,
                      target.origin, target.path,      target.hash};
        return Source{std::move(matrix), target.name};
    }
    if (const auto* load = std::get_if<ast::Load>(&weights)) {
        auto matrix = read_matrix(c, *load);
        if (!matrix) return std::nullopt;
        const std::string key = load->key.empty() ? "" : fmt::format(", \"{}\"", load->key);
        return Source{std::move(*matrix), fmt::format("load(\"{}\"{})", load->path, key)};
    }
    if (const auto* literal = std::get_if<ast::MatrixLiteral>(&weights)) {
        auto matrix = read_matrix(c, *literal);
        if (!matrix) return std::nullopt;
        std::string text = literal_text(*matrix, literal->rows, true);
        return Source{std::move(*matrix), std::move(text)};
    }
    const auto& vector = std::get<ast::VectorLiteral>(weights);
    auto matrix = read_matrix(c, vector);
    if (!matrix) return std::nullopt;
    std::string text = literal_text(*matrix, {vector.values}, false);
    return Source{std::move(*matrix), std::move(text)};
}

/// Returns the first diagonal element that is not positive, or `n`.
std::size_t first_not_positive(const std::vector<float>& values, std::size_t n,
                               std::size_t stride) {
    std::size_t i = 0;
    while (i < n && values[i * stride] > 0) ++i;
    return i;
}

/// Replaces both halves by their mean; false, with an error, if they differ by more than rounding.
/// The diagonal is positive.
bool make_symmetric(Context& c, Matrix& w, Span span) {
    const std::size_t n = w.rows;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            const double a = w.values[i * n + j];
            const double b = w.values[j * n + i];
            const double size = std::sqrt(static_cast<double>(w.values[i * n + i]) *
                                          static_cast<double>(w.values[j * n + j]));
            if (std::abs(a - b) > kSymmetryTolerance * size)
                return c.refuse(
                    Code::weights_not_symmetric, span,
                    fmt::format("the weights are not symmetric: {:g} at row {}, column {} and "
                                "{:g} at row {}, column {} (from 0)",
                                a, i, j, b, j, i));
            w.values[i * n + j] = w.values[j * n + i] = static_cast<float>((a + b) / 2);
        }
    }
    return true;
}

/// Eliminates the upper half in double (Cholesky); returns the first row without a positive pivot,
/// or the number of rows.
std::size_t first_bad_pivot(const Matrix& w) {
    const std::size_t n = w.rows;
    std::vector<double> a(w.values.begin(), w.values.end());
    for (std::size_t k = 0; k < n; ++k) {
        const double pivot = a[k * n + k];
        if (!(pivot > kPivotTolerance * static_cast<double>(w.values[k * n + k]))) return k;
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = a[k * n + i] / pivot;
            if (factor == 0) continue;
            for (std::size_t j = i; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
        }
    }
    return n;
}

bool check_definite(Context& c, Matrix& w, bool diagonal, Span span) {
    const std::size_t n = w.columns;
    const std::size_t bad = first_not_positive(w.values, n, diagonal ? 1 : n + 1);
    if (bad < n)
        return c.refuse(
            Code::weights_not_definite, span,
            fmt::format("the weights are not positive definite: element {} (from 0) of the "
                        "diagonal is {:g}",
                        bad, w.values[bad * (diagonal ? 1 : n + 1)]));
    if (diagonal) return true;
    if (!make_symmetric(c, w, span)) return false;
    const std::size_t row = first_bad_pivot(w);
    if (row == n) return true;
    c.report(Code::weights_not_definite, span,
             fmt::format("the weights are not positive definite: the leading {} x {} block has no "
                         "Cholesky factor",
                         row + 1, row + 1))
        .note("mahalanobis takes the inverse of a covariance");
    return false;
}

/// Fitted weights are for distances from the point that they were fitted to.
std::optional<Weights> fitted_weights(Context& c, const ast::Fitted& written, Index point) {
    const Index index = check_fitted(c, written, Fitted::Slot::metric);
    if (index == kNone) return std::nullopt;
    const Fitted& fitted = c.model.fitted[index];
    if (without_delay(c, fitted.point) != without_delay(c, point))
        return c.no_value(
            Code::wrong_space, written.span,
            fmt::format("the weights are fitted to {}, the distance is from {}",
                        c.model.points[fitted.point].text, c.model.points[point].text));
    Weights weights;
    weights.text = fitted.declaration;
    weights.fitted = index;
    const fitted::Entry* const entry = fitted_entry(c, index);
    if (entry == nullptr) return weights;
    Matrix matrix{entry->rows, entry->columns, false, entry->matrix, "fitted", "", entry->hash};
    if (!check_definite(c, matrix, false, written.span)) return std::nullopt;
    weights.values = std::move(matrix.values);
    return weights;
}

}  // namespace

std::optional<Weights> check_weights(Context& c, const ast::Weights& weights, Index point,
                                     Span span) {
    if (const auto* fitted = std::get_if<ast::Fitted>(&weights))
        return fitted_weights(c, *fitted, point);
    const std::uint32_t dimension = c.model.points[point].dimension;
    auto source = read_source(c, weights);
    if (!source) return std::nullopt;
    Matrix& w = source->matrix;
    const bool diagonal = w.rows == 1;
    const bool fits = w.columns == dimension && (diagonal || w.rows == dimension);
    if (!fits) {
        const std::string shape = w.one_dimensional ? fmt::format("({})", w.columns)
                                                    : fmt::format("({}, {})", w.rows, w.columns);
        return c.no_value(
            Code::weights_shape, span,
            fmt::format("the weights have shape {}; for points of dimension {} expected ({}, "
                        "{}), or the {} elements of a diagonal",
                        shape, dimension, dimension, dimension, dimension));
    }
    if (!check_definite(c, w, diagonal, span)) return std::nullopt;
    return Weights{std::move(w.values), diagonal, std::move(w.path), std::move(source->text),
                   std::move(w.hash)};
}

}  // namespace etlc::check
