// JSON as a tree that keeps the text of its numbers. A key occurs once in an object, and nesting
// and the number of values are limited before memory is spent on them. The items of an array or
// object with one per episode need not become part of the tree: they can be taken as they are
// parsed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::artifacts {

/// Thrown when a file is not as expected.
struct Fault {
    diag::Failure failure;
};

/// Thrown when the bytes cannot be read.
struct Unreadable : Fault {};

/// Text that is read piece by piece: gives one byte after the other, and the place and character of
/// the last ones. Memory is that of a piece. Throws Unreadable for bytes that cannot be read, and
/// for more bytes than the limit.
class Text {
public:
    /// At most `most` bytes count. `unreadable` is the code for more, and for a file that cannot be
    /// read.
    Text(data::ByteSource& source, std::uint64_t most, diag::Code unreadable)
        : source_(source), most_(most), unreadable_(unreadable) {}

    bool at_end() { return at_ == piece_.size() && !next_piece(); }
    /// Returns the next byte, unless at the end.
    char peek() const { return piece_[at_]; }
    void advance() {
        places_[1] = places_[0];
        places_[0] = place_;
        step(piece_[at_++]);
    }

    /// Counts, or not, the bytes read since the last call: bytes that take no memory do not count.
    void pass(bool counts) {
        if (counts) counted_ += read() - passed_;
        passed_ = read();
    }

    /// Returns the place of byte number `at`: one of the last two read, or the next. Columns are
    /// characters.
    source::Position place(std::uint64_t at) const {
        return at == read() ? place_ : places_[std::min<std::uint64_t>(read() - at - 1, 1)];
    }
    /// Returns the UTF-8 character that begins there; empty at the end.
    std::string character(std::uint64_t at);

    /// Reads to the end and returns the number of bytes.
    std::uint64_t finish() {
        for (at_ = piece_.size(); !at_end(); at_ = piece_.size()) pass(false);
        return read();
    }

private:
    std::uint64_t read() const { return begin_ + at_; }
    bool next_piece();
    bool extend();
    void step(char c) {
        if (c == '\n')
            place_ = {place_.line + 1, 1};
        else if (!continues(c))
            ++place_.column;
    }
    /// Returns whether this is not the first byte of a character.
    static bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

    data::ByteSource& source_;
    std::uint64_t most_;
    diag::Code unreadable_;
    std::string piece_;
    std::size_t at_ = 0;       ///< in the piece
    std::uint64_t begin_ = 0;  ///< position of the piece in the text
    source::Position place_{1, 1};
    std::array<source::Position, 2> places_;  ///< of the last two bytes, the later first
    std::uint64_t counted_ = 0;
    std::uint64_t passed_ = 0;  ///< position up to which bytes were counted
};

struct Json {
    enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
    Kind kind = Kind::null;
    std::string text;  ///< number: as written; string: its content; boolean: true or false
    std::vector<std::string> keys;  ///< object
    std::vector<Json> items;        ///< array: elements; object: values, one per key

    const Json* find(const std::string& key) const;
};

inline constexpr std::size_t kMaxJsonDepth = 16;

/// Takes the items of an array or object.
struct ItemTaker {
    /// Called for each key of an object. Detecting repeated keys is left to it.
    std::function<void(const std::string& key)> key;
    /// Called for each value, with its index (array) or key (object). Returns whether the item
    /// takes memory, so that its text counts. Null for items that belong to the tree.
    std::function<bool(std::size_t index, const std::string& key, const Json& item)> item;
};

/// Called at the beginning of every array and object, with the keys above it ("" in an array).
using ItemTakers = std::function<ItemTaker(const std::vector<std::string>& path, Json::Kind kind)>;

/// Parses JSON. Throws faults: `malformed` with line and column, `invalid` for a repeated key. At
/// most `max_values` values of the tree are read.
Json parse_json(Text& text, std::uint64_t max_values, diag::Code malformed, diag::Code invalid,
                const ItemTakers& takers = {});
/// Parses a short text. All faults have one code and are returned.
diag::Result<Json> parse_json(const std::string& text, std::uint64_t max_values, diag::Code code);

/// Returns the fault of a repeated key.
diag::Failure repeated_key(diag::Code code, const std::string& key);

/// Describes a value for a message: "an array", "the text 'x'".
std::string describe(const Json& json);

}  // namespace etlc::artifacts
