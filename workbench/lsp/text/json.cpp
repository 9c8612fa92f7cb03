#include "lsp/text/json.hpp"

#include <fmt/format.h>

#include <limits>

namespace etlc::lsp {

namespace {

[[noreturn]] void refuse(std::string message) {
    throw Refusal{ErrorCode::invalid_params, std::move(message)};
}

}  // namespace

const Json* find(const Json& object, std::string_view key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

const Json* find_path(const Json& object, const std::string& path) {
    const Json::json_pointer pointer("/" + path);
    return object.contains(pointer) ? &object[pointer] : nullptr;
}

const Json& member(const Json& object, std::string_view key) {
    const Json* found = find(object, key);
    if (found == nullptr) refuse(fmt::format("the parameters have no '{}'", key));
    return *found;
}

const std::string& text_of(const Json& object, std::string_view key) {
    const Json& found = member(object, key);
    if (!found.is_string()) refuse(fmt::format("'{}' is not a string", key));
    return found.get_ref<const std::string&>();
}

std::uint32_t number_of(const Json& object, std::string_view key) {
    const Json& found = member(object, key);
    const bool whole = found.is_number_unsigned();
    const auto value = whole ? found.get<std::uint64_t>() : 0;
    if (!whole || value > std::numeric_limits<std::uint32_t>::max())
        refuse(fmt::format("'{}' is not a whole number from 0 to 4294967295", key));
    return static_cast<std::uint32_t>(value);
}

Position position_of(const Json& object) {
    return {number_of(object, "line"), number_of(object, "character")};
}

Range range_of(const Json& object) {
    return {position_of(member(object, "start")), position_of(member(object, "end"))};
}

const std::string& uri_of(const Json& params) {
    return text_of(member(params, "textDocument"), "uri");
}

void to_json(Json& json, const Position& position) {
    json = {{"line", position.line}, {"character", position.character}};
}

void to_json(Json& json, const Range& range) {
    json = {{"start", range.start}, {"end", range.end}};
}

bool nests_too_deep(std::string_view text) {
    constexpr int kDeepest = 256;
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kDeepest) return true;
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return false;
}

std::string framed(const Json& message) {
    const std::string content = message.dump(-1, ' ', false, Json::error_handler_t::replace);
    return fmt::format("Content-Length: {}\r\n\r\n{}", content.size(), content);
}

}  // namespace etlc::lsp
