// Checks target sets.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "check/context/context.hpp"
#include "check/encoders/encoded.hpp"
#include "check/matrices/matrices.hpp"
#include "check/points/fitted.hpp"
#include "check/points/points.hpp"
#include "data/arrays/array.hpp"

namespace etlc::check {

namespace {

using diag::Code;

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
    const Index space = without_delay(c, index);
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
    const Index space = without_delay(c, fitted.point);
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
