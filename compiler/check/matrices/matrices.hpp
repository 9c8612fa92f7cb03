// Matrices of float32 that a spec loads or spells out: target sets and weights.
// Takes: load(...) or a literal. Gives: rows, columns and values.
// Keeps true: rows and columns are at least 1; every value is finite in float32; a file is read
// once, and reported once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// A path of the spec, relative to where etlc runs.
std::string beside_spec(const Context& context, const std::string& path);

/// Whether there is such a file, or nothing can be said of it.
bool exists(const std::string& path);

std::optional<Matrix> read_matrix(Context& context, const ast::Load& load);
std::optional<Matrix> read_matrix(Context& context, const ast::MatrixLiteral& literal);
std::optional<Matrix> read_matrix(Context& context, const ast::VectorLiteral& literal);
template <class... Alternatives>
std::optional<Matrix> read_matrix(Context& context, const std::variant<Alternatives...>& source) {
    return std::visit([&](const auto& s) { return read_matrix(context, s); }, source);
}

}  // namespace etlc::check
