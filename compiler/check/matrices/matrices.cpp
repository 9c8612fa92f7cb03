#include "check/matrices/matrices.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "check/context/context.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"

namespace etlc::check {

namespace {

using diag::Code;

std::string origin_of(const ast::Load& load) {
    return load.key.empty() ? load.path : load.path + ":" + load.key;
}

/// Reports an array that cannot be a matrix.
bool has_usable_shape(Context& c, const data::Array& array, const ast::Load& load) {
    const std::string origin = origin_of(load);
    if (array.element == data::Element::boolean)
        return c.refuse(Code::matrix_elements, load.span,
                        fmt::format("{} has bools; expected numbers", origin));
    if (array.shape.empty() || array.shape.size() > 2)
        return c.refuse(
            Code::matrix_shape, load.span,
            fmt::format(
                "{} has shape {}; expected two dimensions (rows, columns), or one for a single row",
                origin, array.shape_text()));
    for (const std::uint64_t extent : array.shape) {
        if (extent == 0)
            return c.refuse(
                Code::empty_matrix, load.span,
                fmt::format("{} has shape {}, so it holds no values", origin, array.shape_text()));
        if (extent > std::numeric_limits<std::uint32_t>::max())
            return c.refuse(
                Code::matrix_shape, load.span,
                fmt::format("{} has shape {}, which is too large", origin, array.shape_text()));
    }
    return true;
}

/// Rounds the values to float32; false after an error at the first that is not finite.
bool round_values(Context& c, const data::Array& array, const ast::Load& load, Matrix& matrix) {
    matrix.values.reserve(array.values.size());
    for (std::size_t i = 0; i < array.values.size(); ++i) {
        matrix.values.push_back(static_cast<float>(array.values[i]));
        if (std::isfinite(matrix.values.back())) continue;
        return c.refuse(
            Code::value_not_finite, load.span,
            fmt::format(
                "{} has {:g} at row {}, column {} (both from 0), which is not a finite float32",
                origin_of(load), array.values[i], i / matrix.columns, i % matrix.columns));
    }
    return true;
}

std::optional<Matrix> read_file(Context& c, const ast::Load& load, const std::string& path) {
    c.dependencies.insert(path);
    auto array = data::read_array(path, load.key);
    if (!array) {
        diag::Diagnostic diagnostic = data::in_file(array.failure(), path);
        diagnostic.span = load.span;
        const bool lacks_file = diagnostic.code == Code::unreadable_data_file && !exists(path);
        const bool lacks_key = diagnostic.code == Code::no_such_array && !load.key.empty();
        c.report_data(std::move(diagnostic), lacks_file || lacks_key);
        return std::nullopt;
    }
    if (!has_usable_shape(c, *array, load)) return std::nullopt;
    Matrix matrix;
    matrix.one_dimensional = array->shape.size() == 1;
    matrix.rows = matrix.one_dimensional ? 1 : static_cast<std::uint32_t>(array->shape[0]);
    matrix.columns = static_cast<std::uint32_t>(array->shape.back());
    if (!round_values(c, *array, load, matrix)) return std::nullopt;
    array->values = {};  // saves memory for large sets
    matrix.origin = origin_of(load);
    matrix.path = path;
    matrix.hash = data::content_hash({matrix.rows, matrix.columns}, matrix.values);
    return matrix;
}

/// Only files without errors are cached.
std::optional<Matrix> cached_or_read(Context& c, const ast::Load& load, const std::string& path) {
    if (c.cache == nullptr) return read_file(c, load, path);
    std::error_code error;
    const auto time = std::filesystem::last_write_time(path, error);
    const auto size = error ? 0 : std::filesystem::file_size(path, error);
    if (error) return read_file(c, load, path);
    const auto found = c.cache->find({path, load.key});
    if (found != c.cache->end() && found->second.time == time && found->second.size == size) {
        c.dependencies.insert(path);
        return found->second.matrix;
    }
    auto matrix = read_file(c, load, path);
    if (matrix) c.cache->insert_or_assign({path, load.key}, CachedMatrix{time, size, *matrix});
    return matrix;
}

std::optional<Matrix> literal_matrix(Context& c,
                                     const std::vector<std::vector<ast::Number>>& rows) {
    Matrix matrix;
    matrix.rows = static_cast<std::uint32_t>(rows.size());
    matrix.columns = static_cast<std::uint32_t>(rows[0].size());
    const std::size_t errors = c.sink.errors();
    for (const auto& row : rows)
        for (const ast::Number& number : row) matrix.values.push_back(number32(c, number));
    if (c.sink.errors() > errors) return std::nullopt;
    matrix.origin = "literal";
    matrix.hash = data::content_hash({matrix.rows, matrix.columns}, matrix.values);
    return matrix;
}

}  // namespace

std::string beside_spec(const Context& c, const std::string& path) {
    return data::beside(c.file.path(), path);
}

bool exists(const std::string& path) {
    std::error_code unknown;
    return std::filesystem::exists(path, unknown) || unknown;
}

std::optional<Matrix> read_matrix(Context& c, const ast::Load& load) {
    const std::string path = beside_spec(c, load.path);
    const auto [at, is_new] = c.matrices.try_emplace({path, load.key});
    if (is_new) at->second = cached_or_read(c, load, path);
    return at->second;
}

std::optional<Matrix> read_matrix(Context& c, const ast::MatrixLiteral& literal) {
    if (literal.rows.empty() || literal.rows[0].empty())
        return c.no_value(Code::empty_matrix, literal.span, "a matrix without values");
    const std::size_t columns = literal.rows[0].size();
    for (std::size_t i = 0; i < literal.rows.size(); ++i) {
        const auto& row = literal.rows[i];
        if (row.size() == columns) continue;
        const Span span =
            row.empty() ? literal.span : source::join(row.front().span, row.back().span);
        return c.no_value(
            Code::ragged_matrix, span,
            fmt::format(
                "row {} (from 0) has {}, row 0 has {}; all rows of a matrix have the same length",
                i, diag::counted(row.size(), "value"), columns));
    }
    return literal_matrix(c, literal.rows);
}

std::optional<Matrix> read_matrix(Context& c, const ast::VectorLiteral& literal) {
    if (literal.values.empty())
        return c.no_value(Code::empty_matrix, literal.span, "a vector without values");
    auto matrix = literal_matrix(c, {literal.values});
    if (matrix) matrix->one_dimensional = true;
    return matrix;
}

}  // namespace etlc::check
