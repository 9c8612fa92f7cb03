// The target sets.
#include <fmt/format.h>

#include "check/predicates/matrices.hpp"
#include "check/steps.hpp"

namespace etlc::check {

namespace {

using diag::Code;

std::optional<Matrix> target_matrix(Context& c, const ast::Target& declaration) {
    if (const auto* load = std::get_if<ast::Load>(&declaration.value)) return read_matrix(c, *load);
    if (const auto* literal = std::get_if<ast::MatrixLiteral>(&declaration.value))
        return read_matrix(c, *literal);
    const auto& vector = std::get<ast::VectorLiteral>(declaration.value);
    const std::string words{c.file.text(vector.span)};
    c.report(
         Code::target_is_vector, vector.span,
         "a target is a set of embeddings, one a row, so a literal is a matrix; this is a vector")
        .note(words.size() <= 60 ? fmt::format("for a set of one embedding write [{}]", words)
                                 : "for a set of one embedding put it in another pair of brackets");
    return std::nullopt;
}

}  // namespace

void check_targets(Context& c) {
    for_each_declaration<ast::Target>(c.spec, [&](const ast::Target& declaration, Index index) {
        Target target;
        target.name = declaration.name.text;
        target.span = declaration.name.span;
        if (auto matrix = target_matrix(c, declaration)) {
            target.rows = matrix->rows;
            target.dimension = matrix->columns;
            target.values = std::move(matrix->values);
            target.origin = std::move(matrix->origin);
            target.path = std::move(matrix->path);
            target.hash = std::move(matrix->hash);
        } else {
            c.scope.entity(NameKind::target, index).broken = true;
        }
        c.model.targets.push_back(std::move(target));
    });
}

}  // namespace etlc::check
