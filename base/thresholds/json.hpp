// JSON as a tree that keeps the text of its numbers.
// Takes: text. Gives: the tree, or where and why it is not JSON. Keeps true: a key stands once in
// an object, nesting and the number of values are limited before memory is spent on them, and a
// number is never rounded on the way. Arrays and objects with an item for every episode need not
// become part of the tree: their items are taken as they come.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "thresholds/text.hpp"

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

/// What became of an item that is not in the tree.
struct Taken {
    bool keeps = false;                    ///< takes memory, so that its text counts
    std::optional<diag::Failure> failure;  ///< ends the reading
};

/// Takes the items of an array or object.
struct ItemTaker {
    /// Of an object: a key has come. Whether it stands twice is not looked at elsewhere; a failure
    /// ends the reading.
    std::function<std::optional<diag::Failure>(const std::string& key)> key;
    /// Of an array the value at `index`, of an object that of `key`. Nothing: they are no items,
    /// and belong to the tree.
    std::function<Taken(std::size_t index, const std::string& key, const Json& item)> item;
};

/// Asked of every array and object where it begins, with the keys above it ("" in an array).
using ItemTakers = std::function<ItemTaker(const std::vector<std::string>& path, Json::Kind kind)>;

/// Failures: `malformed` with line and column; `invalid` where a key stands twice. `max_values`: of
/// the tree.
diag::Result<Json> parse_json(Text& text, std::uint64_t max_values, diag::Code malformed,
                              diag::Code invalid, const ItemTakers& takers = {});
diag::Result<Json> parse_json(const std::string& text, std::uint64_t max_values,
                              diag::Code malformed, diag::Code invalid,
                              const ItemTakers& takers = {});

/// "a string", "a number", ...: what a message calls it.
std::string describe(const Json& json);

}  // namespace etlc::thresholds
