// Checked access to the JSON of messages, whose shape is not trusted. Throws Refusal where a member
// is missing or has another type.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "source/source.hpp"

namespace etlc::lsp {

// Converts byte offsets of UTF-8 text to the protocol's lines and characters, and back.
// Keeps true: lines end at \n, \r\n or \r; a character is a UTF-16 unit, or a byte where the client
// agreed to that; every position has an offset: a position beyond a line maps to its end, one
// beyond the text to the end of the text, one inside a character to its beginning.

enum class Encoding : std::uint8_t { utf16, utf8 };

struct Position {
    std::uint32_t line = 0;
    std::uint32_t character = 0;

    auto operator<=>(const Position&) const = default;
};

struct Range {
    Position start;
    Position end;

    bool operator==(const Range&) const = default;
};

/// The lines of a text, which must outlive them.
class Lines {
public:
    Lines(std::string_view text, Encoding encoding);

    std::size_t count() const { return begins_.size(); }
    std::uint32_t offset(Position position) const;
    Position position(std::uint32_t offset) const;
    Range range(source::Span span) const { return {position(span.begin), position(span.end)}; }
    source::Span span(Range range) const { return {offset(range.start), offset(range.end)}; }

private:
    /// Returns the end of a line, before its line break.
    std::uint32_t end_of(std::size_t line) const;

    std::string_view text_;
    Encoding encoding_;
    std::vector<std::uint32_t> begins_{0};
};

using Json = nlohmann::json;

/// The codes of JSON-RPC and of the protocol.
enum class ErrorCode : std::int32_t {
    parse_error = -32700,
    invalid_request = -32600,
    method_not_found = -32601,
    invalid_params = -32602,
    server_not_initialized = -32002,
    request_failed = -32803,
};

/// Why a request gets an error in place of a result.
struct Refusal {
    ErrorCode code;
    std::string message;
};

/// Finds a member; null where `object` is not an object or lacks it.
const Json* find(const Json& object, std::string_view key);
/// Finds the member at the end of a path, "general/positionEncodings"; null where it is missing.
const Json* find_path(const Json& object, const std::string& path);

const Json& member(const Json& object, std::string_view key);
const std::string& text_of(const Json& object, std::string_view key);
std::uint32_t number_of(const Json& object, std::string_view key);
Position position_of(const Json& object);
Range range_of(const Json& object);
/// Returns params.textDocument.uri.
const std::string& uri_of(const Json& params);

void to_json(Json& json, const Position& position);
void to_json(Json& json, const Range& range);

/// Returns whether brackets nest so deep that parsing the text, or freeing the result, would
/// overflow the stack.
bool nests_too_deep(std::string_view text);

/// Returns a message with its header. Bytes that are not UTF-8 become U+FFFD.
std::string framed(const Json& message);

// Converts between the URIs of documents and the paths of files.

/// Returns the path of a file: URI. For any other, such as that of an unsaved text, returns the
/// last part, so that files of the spec are looked for in the working directory.
std::string path_of_uri(std::string_view uri);

/// Returns the file: URI of a path, which is made absolute.
std::string uri_of_path(const std::string& path);

}  // namespace etlc::lsp
