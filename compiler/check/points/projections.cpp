// Checks projections: matrices that are loaded, literal or fitted.
#include <fmt/format.h>

#include "check/context/context.hpp"
#include "check/matrices/matrices.hpp"
#include "check/points/fitted.hpp"
#include "check/points/project.hpp"

namespace etlc::check {

namespace {

using diag::Code;

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
            const bool good = fitted != nullptr ? set_fitted(c, *fitted, projection)
                                                : set_numbers(c, declaration, projection);
            if (!good) c.scope.entity(NameKind::projection, index).broken = true;
            c.model.projections.push_back(std::move(projection));
        });
}

}  // namespace etlc::check
