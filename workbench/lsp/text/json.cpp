#include "lsp/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <limits>
#include <system_error>

#include "source/text.hpp"

namespace etlc::lsp {

namespace {

[[noreturn]] void refuse_parameters(std::string message) {
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
    if (found == nullptr) refuse_parameters(fmt::format("the parameters have no '{}'", key));
    return *found;
}

const std::string& text_of(const Json& object, std::string_view key) {
    const Json& found = member(object, key);
    if (!found.is_string()) refuse_parameters(fmt::format("'{}' is not a string", key));
    return found.get_ref<const std::string&>();
}

std::uint32_t number_of(const Json& object, std::string_view key) {
    const Json& found = member(object, key);
    const bool whole = found.is_number_unsigned();
    const auto value = whole ? found.get<std::uint64_t>() : 0;
    if (!whole || value > std::numeric_limits<std::uint32_t>::max())
        refuse_parameters(fmt::format("'{}' is not a whole number from 0 to 4294967295", key));
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

namespace {

/// Returns the size of the first character; a byte that is not UTF-8 counts as one.
std::size_t bytes_of_first(std::string_view text) {
    return std::max<std::size_t>(1, source::utf8_length(text));
}

/// Characters beyond the basic plane have four bytes and two UTF-16 units.
std::uint32_t units_of(std::size_t bytes, Encoding encoding) {
    if (encoding == Encoding::utf8) return static_cast<std::uint32_t>(bytes);
    return bytes == 4 ? 2 : 1;
}

}  // namespace

Lines::Lines(std::string_view text, Encoding encoding) : text_(text), encoding_(encoding) {
    for (std::uint32_t at = 0; at < text.size(); ++at) {
        const bool ends = text[at] == '\n' ||
                          (text[at] == '\r' && (at + 1 == text.size() || text[at + 1] != '\n'));
        if (ends) begins_.push_back(at + 1);
    }
}

std::uint32_t Lines::end_of(std::size_t line) const {
    if (line + 1 == begins_.size()) return static_cast<std::uint32_t>(text_.size());
    std::uint32_t end = begins_[line + 1] - 1;
    if (text_[end] == '\n' && end > begins_[line] && text_[end - 1] == '\r') --end;
    return end;
}

std::uint32_t Lines::offset(Position position) const {
    if (position.line >= begins_.size()) return static_cast<std::uint32_t>(text_.size());
    const std::uint32_t end = end_of(position.line);
    std::uint32_t at = begins_[position.line];
    std::uint32_t left = position.character;
    while (at < end && left > 0) {
        const std::size_t bytes = bytes_of_first(text_.substr(at));
        const std::uint32_t units = units_of(bytes, encoding_);
        if (units > left) break;
        left -= units;
        at += static_cast<std::uint32_t>(bytes);
    }
    return at;
}

Position Lines::position(std::uint32_t offset) const {
    offset = std::min(offset, static_cast<std::uint32_t>(text_.size()));
    const auto next = std::upper_bound(begins_.begin(), begins_.end(), offset);
    const auto line = static_cast<std::size_t>(next - begins_.begin()) - 1;
    offset = std::min(offset, end_of(line));
    Position result{static_cast<std::uint32_t>(line), 0};
    for (std::uint32_t at = begins_[line]; at < offset;) {
        const std::size_t bytes = bytes_of_first(text_.substr(at));
        if (at + bytes > offset) break;
        result.character += units_of(bytes, encoding_);
        at += static_cast<std::uint32_t>(bytes);
    }
    return result;
}

namespace {

/// Decodes %20 and the like; incomplete sequences stay.
std::string decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned byte = 0;
        const char* const digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            result += static_cast<char>(byte);
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

}  // namespace

std::string path_of_uri(std::string_view uri) {
    constexpr std::string_view kScheme = "file://";
    if (uri.starts_with(kScheme)) {
        uri.remove_prefix(kScheme.size());
        const std::size_t path = uri.find('/');  // after the host, which is usually empty
        return path == std::string_view::npos ? "" : decoded(uri.substr(path));
    }
    const std::size_t last = uri.find_last_of("/:");
    return decoded(last == std::string_view::npos ? uri : uri.substr(last + 1));
}

std::string uri_of_path(const std::string& path) {
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(path, error);
    std::string result = "file://";
    for (const char c : error ? path : absolute.lexically_normal().string()) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                           std::string_view("/-._~").find(c) != std::string_view::npos;
        if (plain)
            result += c;
        else
            result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return result;
}

}  // namespace etlc::lsp
