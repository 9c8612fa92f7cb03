// Reads matrices of float32 that a spec loads or contains: target sets and weights. There is at
// least one row and one column, and every value is finite in float32. A file is read once and its
// errors are reported once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// Returns a path of the spec relative to the working directory.
std::string beside_spec(const Context& context, const std::string& path);

/// Whether the file exists, or cannot be examined.
bool exists(const std::string& path);

std::optional<Matrix> read_matrix(Context& context, const ast::Load& load);
std::optional<Matrix> read_matrix(Context& context, const ast::MatrixLiteral& literal);
std::optional<Matrix> read_matrix(Context& context, const ast::VectorLiteral& literal);
template <class... Alternatives>
std::optional<Matrix> read_matrix(Context& context, const std::variant<Alternatives...>& source) {
    return std::visit([&](const auto& s) { return read_matrix(context, s); }, source);
}

}  // namespace etlc::check
