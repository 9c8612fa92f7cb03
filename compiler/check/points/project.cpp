#include "check/points/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/context/context.hpp"
#include "check/matrices/matrices.hpp"
#include "data/arrays/array.hpp"

namespace etlc::check {

namespace {

/// Returns the projections between two points, innermost first; `from` is on the way to `to`.
std::vector<Index> maps_between(const Model& model, Index from, Index to) {
    std::vector<Index> maps;
    for (Index at = to; at != from; at = model.points[at].inner)
        maps.push_back(model.points[at].projection);
    std::reverse(maps.begin(), maps.end());
    return maps;
}

/// Returns the point without its projections.
Index innermost(const Model& model, Index point) {
    while (model.points[point].is_projected()) point = model.points[point].inner;
    return point;
}

bool is_finite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

std::vector<double> projected(const Projection& projection, const std::vector<double>& z) {
    std::vector<double> result(projection.rows);
    for (std::size_t i = 0; i < projection.rows; ++i) {
        const float* row = projection.matrix.data() + i * projection.dimension;
        for (std::size_t j = 0; j < projection.dimension; ++j) {
            const double offset =
                projection.offset.empty() ? 0 : static_cast<double>(projection.offset[j]);
            result[i] += static_cast<double>(row[j]) * (z[j] - offset);
        }
    }
    return result;
}

std::vector<double> projected(const Model& model, Index point, std::vector<double> z) {
    for (const Index map : maps_between(model, innermost(model, point), point))
        z = projected(model.projections[map], z);
    return z;
}

std::optional<std::uint32_t> project_target(Model& model, Index index) {
    Target& target = model.targets[index];
    const Target& source = model.targets[target.source];
    const Index from = source.space == kNone ? innermost(model, target.space) : source.space;
    const std::vector<Index> maps = maps_between(model, from, target.space);
    target.values.clear();
    const auto is_there = [&](Index map) { return !model.projections[map].matrix.empty(); };
    if (source.values.empty() || !std::all_of(maps.begin(), maps.end(), is_there)) return {};
    for (std::size_t row = 0; row < source.rows; ++row) {
        const float* begin = source.values.data() + row * source.dimension;
        std::vector<double> z(begin, begin + source.dimension);
        for (const Index map : maps) z = projected(model.projections[map], z);
        for (const double x : z) target.values.push_back(static_cast<float>(x));
    }
    target.hash = data::content_hash({target.rows, target.dimension}, target.values);
    if (is_finite(target.values)) return {};
    const auto first = std::find_if_not(target.values.begin(), target.values.end(),
                                        [](float x) { return std::isfinite(x); });
    return static_cast<std::uint32_t>((first - target.values.begin()) / target.dimension);
}

std::optional<Index> fill(Model& model, Index index, const Filling& filling) {
    Fitted& fitted = model.fitted[index];
    switch (fitted.slot) {
        case Fitted::Slot::target:
            model.targets[fitted.index].values = filling.matrix;
            model.targets[fitted.index].hash =
                data::content_hash({fitted.rows, fitted.columns}, filling.matrix);
            break;
        case Fitted::Slot::projection: {
            Projection& projection = model.projections[fitted.index];
            projection.matrix = filling.matrix;
            projection.offset = filling.offset;
            projection.hash = projection_hash(projection);
            break;
        }
        case Fitted::Slot::metric:
            for (Distance& distance : model.distances)
                if (distance.weights_fitted == index) distance.weights = filling.matrix;
            break;
    }
    fitted.filled = true;
    for (Index target = 0; target < model.targets.size(); ++target)
        if (model.targets[target].source != kNone && project_target(model, target)) return target;
    return std::nullopt;
}

namespace {

bool rests_on_fitted(const Model& model, Index index) {
    const Point& point = model.points[index];
    if (point.is_projected() && model.projections[point.projection].fitted != kNone) return true;
    if (point.inner != kNone) return rests_on_fitted(model, point.inner);
    return std::any_of(point.parts.begin(), point.parts.end(),
                       [&](Index part) { return rests_on_fitted(model, part); });
}

}  // namespace

bool rests_on_fitted(const Model& model, const Distance& distance) {
    if (distance.weights_fitted != kNone) return true;
    if (!distance.is_between_points() && model.targets[distance.target].fitted != kNone)
        return true;
    return rests_on_fitted(model, distance.point) ||
           (distance.is_between_points() && rests_on_fitted(model, distance.other));
}

std::uint32_t longest_delay(const Model& model, Index index) {
    const Point& point = model.points[index];
    std::uint32_t longest = point.inner == kNone ? 0 : longest_delay(model, point.inner);
    for (const Index part : point.parts) longest = std::max(longest, longest_delay(model, part));
    return longest + point.steps;
}

Index as_of_now(const Model& model, Index index) {
    const Point& point = model.points[index];
    if (!point.parts.empty()) return kNone;
    if (point.is_delayed()) return as_of_now(model, point.inner);
    if (!point.is_projected()) return index;
    const Index inner = as_of_now(model, point.inner);
    if (inner == point.inner || inner == kNone) return inner == kNone ? kNone : index;
    const auto found =
        std::find_if(model.points.begin(), model.points.end(), [&](const Point& other) {
            return other.projection == point.projection && other.inner == inner;
        });
    return found == model.points.end() ? kNone : static_cast<Index>(found - model.points.begin());
}

bool is_recorded(const Model& model, Index index) {
    const Point& point = model.points[index];
    if (point.is_projected()) return false;
    if (point.inner != kNone) return is_recorded(model, point.inner);
    return std::all_of(point.parts.begin(), point.parts.end(),
                       [&](Index part) { return is_recorded(model, part); });
}

std::string projection_hash(const Projection& projection) {
    std::vector<float> values = projection.matrix;
    values.insert(values.end(), projection.offset.begin(), projection.offset.end());
    const std::uint64_t more = projection.offset.empty() ? 0 : 1;
    return data::content_hash({projection.rows + more, projection.dimension}, values);
}

// Checks projections: matrices that are loaded, literal or fitted.

namespace {

using diag::Code;

/// Puts the projection into a space; false, with an error, if those in it have other dimensions.
bool set_space(Context& c, const ast::Name& space, Projection& projection) {
    if (const Reference* const meant = c.scope.find(space.text)) {
        c.report(Code::wrong_kind, space.span,
                 fmt::format("'{}' is {}; expected a name for the space, which is no other's",
                             space.text, word_with_article(meant->kind)))
            .note(c.scope.entity(*meant).span, fmt::format("'{}' is declared here", space.text));
        return false;
    }
    projection.space = space.text;
    for (const Projection& other : c.model.projections) {
        const bool fits = other.rows == 0 || other.rows == projection.rows;  // 0: not readable
        if (other.space != space.text || fits) continue;
        c.report(
             Code::dimension_mismatch, space.span,
             fmt::format("'{}' has dimension {}, '{}' has dimension {}; the points of one space, "
                         "'{}', have one dimension",
                         projection.name, projection.rows, other.name, other.rows, space.text))
            .note(other.span, fmt::format("'{}' is declared here", other.name));
        return false;
    }
    return true;
}

/// Sets the offset; false, with an error, if it does not fit the matrix.
bool set_offset(Context& c, const ast::Projection::Numbers& written, Projection& projection) {
    auto offset = read_matrix(c, written);
    if (!offset) return false;
    if (offset->rows != 1 || offset->columns != projection.dimension)
        return c.refuse(
            Code::projection_form, span_of(written),
            fmt::format("the offset has shape ({}, {}); expected one row of {}, one for each "
                        "column of the matrix",
                        offset->rows, offset->columns, projection.dimension));
    projection.offset = std::move(offset->values);
    return true;
}

bool set_numbers(Context& c, const ast::Projection& declaration, Projection& projection) {
    if (const auto* vector = std::get_if<ast::VectorLiteral>(&declaration.matrix)) {
        c.report(Code::projection_form, vector->span,
                 "a projection is a matrix, one row per result: expected a matrix, found a vector")
            .note("for a projection to a single number add another pair of brackets");
        return false;
    }
    auto matrix = std::holds_alternative<ast::Load>(declaration.matrix)
                      ? read_matrix(c, std::get<ast::Load>(declaration.matrix))
                      : read_matrix(c, std::get<ast::MatrixLiteral>(declaration.matrix));
    if (!matrix) return false;
    projection.rows = matrix->rows;
    projection.dimension = matrix->columns;
    projection.matrix = std::move(matrix->values);
    projection.origin = std::move(matrix->origin);
    projection.path = std::move(matrix->path);
    if (declaration.offset && !set_offset(c, *declaration.offset, projection)) return false;
    projection.hash = projection_hash(projection);
    return true;
}

bool set_fitted(Context& c, const ast::Fitted& written, Projection& projection) {
    const auto index = static_cast<Index>(c.model.projections.size());
    projection.fitted = check_fitted(c, written, Fitted::Slot::projection, projection.name, index);
    if (projection.fitted == kNone) return false;
    const Fitted& fitted = c.model.fitted[projection.fitted];
    projection.rows = fitted.rows;
    projection.dimension = fitted.columns;
    projection.origin = "fitted";
    if (const fitted::Entry* const entry = fitted_entry(c, projection.fitted)) {
        projection.matrix = entry->matrix;
        projection.offset = entry->offset;
        projection.hash = entry->hash;
    }
    return true;
}

}  // namespace

void check_projections(Context& c) {
    for_each_declaration<ast::Projection>(
        c.spec, [&](const ast::Projection& declaration, Index index) {
            Projection projection;
            projection.name = declaration.name.text;
            projection.span = declaration.name.span;
            const auto* const fitted = std::get_if<ast::Fitted>(&declaration.matrix);
            bool good = fitted != nullptr ? set_fitted(c, *fitted, projection)
                                          : set_numbers(c, declaration, projection);
            if (declaration.space) good = good && set_space(c, *declaration.space, projection);
            if (!good) c.scope.entity(NameKind::projection, index).broken = true;
            c.model.projections.push_back(std::move(projection));
        });
}

}  // namespace etlc::check
