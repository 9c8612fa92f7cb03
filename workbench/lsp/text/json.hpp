// Checked access to the JSON of messages, whose shape is not trusted. Throws Refusal where a member
// is missing or has another type.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "lsp/text/position.hpp"

namespace etlc::lsp {

using Json = nlohmann::json;

/// The codes of JSON-RPC and of the protocol.
enum class ErrorCode : std::int32_t {
    parse_error = -32700,
    invalid_request = -32600,
    method_not_found = -32601,
    invalid_params = -32602,
    internal_error = -32603,
    server_not_initialized = -32002,
    request_failed = -32803,
    request_cancelled = -32800,
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

}  // namespace etlc::lsp
