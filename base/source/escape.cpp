#include "source/escape.hpp"

#include <fmt/format.h>

#include <cctype>

#include "source/utf8.hpp"

namespace etlc::source {

namespace {

/// Calls `take` with each character, or each byte that belongs to none, and whether it is a
/// character.
template <class Take>
void for_each_character(std::string_view text, const Take& take) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        take(text.substr(0, length == 0 ? 1 : length), length > 0);
        text.remove_prefix(length == 0 ? 1 : length);
    }
}

}  // namespace

std::string visible(std::string_view text) {
    std::string result;
    for_each_character(text, [&](std::string_view character, bool valid) {
        const char32_t value = valid ? code_point(character) : U'\0';
        if (!is_hidden(value))
            result += character;
        else if (character.size() == 1)
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(character[0]));
        else
            result += fmt::format("\\u{{{:X}}}", static_cast<unsigned>(value));
    });
    return result;
}

std::string visible_lines(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        result += visible(text.substr(0, end));
        if (end == std::string_view::npos) break;
        result += '\n';
        text.remove_prefix(end + 1);
    }
    return result;
}

std::string code_line(std::string_view text) {
    std::string line = visible(text);
    line.erase(line.find_last_not_of(' ') + 1);
    // A backslash joins the next line to this one, and so does its trigraph.
    if (line.ends_with('\\')) return line + "x5c";
    if (line.ends_with("?\?/")) return line.substr(0, line.size() - 1) + "\\x2f";
    return line;
}

std::string json_string(std::string_view text) {
    std::string result;
    for_each_character(text, [&](std::string_view character, bool valid) {
        const auto byte = static_cast<unsigned char>(character[0]);
        if (!valid)
            result += "\\ufffd";
        else if (byte < 0x20)
            result += fmt::format("\\u{:04x}", byte);
        else
            result.append(byte == '"' || byte == '\\' ? "\\" : "").append(character);
    });
    return '"' + result + '"';
}

std::string csv_cell(std::string_view text) {
    if (text.find_first_of(",\"\n") == text.npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string dot_string(std::string_view text) {
    std::string result;
    for (const char c : visible(text)) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return '"' + result + '"';
}

std::optional<std::string> depfile_path(std::string_view path, InRule place) {
    constexpr std::string_view kRead = "!$#%(),+-./:@_{} ~";
    std::string result;
    for (const char c : path) {
        const auto byte = static_cast<unsigned char>(c);
        const bool read =
            byte >= 0x80 || std::isalnum(byte) != 0 || kRead.find(c) != std::string_view::npos;
        if (!read || (c == '%' && place == InRule::target)) return std::nullopt;
        if (c == ' ' || c == '#' || c == ':') result += '\\';
        if (c == '$') result += '$';
        result += c;
    }
    // These are a home folder, a member of an archive, and an end that make or ninja interprets.
    if (path.empty() || path[0] == '~' ||
        std::string_view(") :").find(path.back()) != std::string_view::npos)
        return std::nullopt;
    return result;
}

}  // namespace etlc::source
