#include "source/text.hpp"

#include <fmt/format.h>

#include <cctype>

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

std::size_t utf8_length(std::string_view text) {
    if (text.empty()) return 0;
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    if (lead < 0xC2 || lead > 0xF4) return 0;
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if (!is_continuation(text[i])) return 0;
    // The second byte excludes overlong forms, surrogates and values above U+10FFFF.
    const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
    const bool surrogate = lead == 0xED && byte(1) >= 0xA0;
    const bool too_large = lead == 0xF4 && byte(1) >= 0x90;
    return overlong || surrogate || too_large ? 0 : length;
}

std::size_t first_invalid_utf8(std::string_view text) {
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t length = utf8_length(text.substr(at));
        if (length == 0) break;
        at += length;
    }
    return at;
}

char32_t code_point(std::string_view character) {
    const auto byte = [character](std::size_t i) {
        return static_cast<unsigned char>(character[i]);
    };
    if (character.size() == 1) return byte(0);
    char32_t value = byte(0) & (0x7FU >> character.size());
    for (std::size_t i = 1; i < character.size(); ++i) value = (value << 6U) | (byte(i) & 0x3FU);
    return value;
}

bool is_hidden(char32_t character) {
    // C0; DEL and C1; soft hyphen; Arabic letter mark; fillers; Mongolian vowel separators; zero
    // widths, directions; separators, embeddings; joiners, isolates; byte order mark; annotations;
    // tags.
    constexpr std::array<CodePoints, 15> kHidden{{{0, 0x1F},
                                                  {0x7F, 0x9F},
                                                  {0xAD, 0xAD},
                                                  {0x61C, 0x61C},
                                                  {0x115F, 0x1160},
                                                  {0x17B4, 0x17B5},
                                                  {0x180B, 0x180F},
                                                  {0x200B, 0x200F},
                                                  {0x2028, 0x202E},
                                                  {0x2060, 0x206F},
                                                  {0x3164, 0x3164},
                                                  {0xFEFF, 0xFEFF},
                                                  {0xFFA0, 0xFFA0},
                                                  {0xFFF0, 0xFFFB},
                                                  {0xE0000, 0xE0FFF}}};
    return is_in(kHidden, character);
}

}  // namespace etlc::source
