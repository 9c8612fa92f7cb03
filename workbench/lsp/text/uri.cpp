#include "lsp/text/uri.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <system_error>

namespace etlc::lsp {

namespace {

int hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const int letter = std::tolower(static_cast<unsigned char>(c));
    return letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : -1;
}

/// Decodes %20 and the like; incomplete sequences stay.
std::string decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool triple = text[i] == '%' && i + 2 < text.size() &&
                            hexadecimal(text[i + 1]) >= 0 && hexadecimal(text[i + 2]) >= 0;
        if (triple) {
            result += static_cast<char>(16 * hexadecimal(text[i + 1]) + hexadecimal(text[i + 2]));
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
