// Messages as JSON, and what a client may have got wrong in them.
// Takes: params of any shape. Gives: their members, checked. Throws Refusal where one is not there
// or is of another type. Keeps true: nothing that a client sends is trusted to have a shape.
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

/// Null where `object` is none or has no such member.
const Json* find(const Json& object, std::string_view key);
/// The member at the end of a path, "general/positionEncodings"; null where there is none.
const Json* find_path(const Json& object, std::string_view path);

const Json& member(const Json& object, std::string_view key);
const std::string& text_of(const Json& object, std::string_view key);
std::uint32_t number_of(const Json& object, std::string_view key);
Position position_of(const Json& object);
Range range_of(const Json& object);
/// params.textDocument.uri
const std::string& uri_of(const Json& params);

Json json_of(Position position);
Json json_of(Range range);

/// Whether brackets nest so deep that reading or forgetting the text would take too much.
bool nests_too_deep(std::string_view text);

/// With its header, as it is sent. Bytes that are not UTF-8 become U+FFFD.
std::string framed(const Json& message);

}  // namespace etlc::lsp
