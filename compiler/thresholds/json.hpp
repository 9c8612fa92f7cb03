// JSON as a tree that keeps the text of its numbers.
// Takes: text. Gives: the tree, or where and why it is not JSON. Keeps true: a key stands once in
// an object, nesting and the number of values are limited before memory is spent on them, and a
// number is never rounded on the way.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::thresholds {

struct Json {
    enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
    Kind kind = Kind::null;
    std::string text;  ///< number: as written; string: its content; boolean: true or false
    std::vector<std::string> keys;  ///< object
    std::vector<Json> items;        ///< array: elements; object: values, one per key

    const Json* find(const std::string& key) const;
};

inline constexpr std::size_t kMaxJsonDepth = 16;

/// Failures: `malformed` with line and column; `invalid` where a key stands twice.
diag::Result<Json> parse_json(const std::string& text, std::uint64_t max_values,
                              diag::Code malformed, diag::Code invalid);

/// "a string", "a number", ...: what a message calls it.
std::string describe(const Json& json);

}  // namespace etlc::thresholds
