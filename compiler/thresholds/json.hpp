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

/// Takes an item: of an array the value at `index`, of an object that of `key`. Keys that stand
/// twice are its own affair.
using TakeItem = std::function<Taken(std::size_t index, const std::string& key, const Json& item)>;

/// Asked of every array and object where it begins, with the keys above it ("" in an array): what
/// takes its items, so that it is empty in the tree; nothing where they belong to the tree.
using ItemTaker = std::function<TakeItem(const std::vector<std::string>& path, Json::Kind kind)>;

/// Failures: `malformed` with line and column; `invalid` where a key stands twice. `max_values`: of
/// the tree.
diag::Result<Json> parse_json(Text& text, std::uint64_t max_values, diag::Code malformed,
                              diag::Code invalid, const ItemTaker& taker = {});
diag::Result<Json> parse_json(const std::string& text, std::uint64_t max_values,
                              diag::Code malformed, diag::Code invalid,
                              const ItemTaker& taker = {});

/// "a string", "a number", ...: what a message calls it.
std::string describe(const Json& json);

}  // namespace etlc::thresholds
