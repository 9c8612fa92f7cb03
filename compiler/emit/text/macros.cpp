#include "emit/text/macros.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "check/names/reserved.hpp"

namespace etlc::emit {

namespace {

bool in_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Returns the position after the string literal that begins at `at`.
std::size_t end_of_string(std::string_view code, std::size_t at) {
    for (++at; at < code.size() && code[at] != '"'; ++at)
        if (code[at] == '\\') ++at;
    return at + 1;
}

/// Returns the words outside strings and comments that may be macros elsewhere.
std::set<std::string> macros_in(std::string_view code) {
    std::set<std::string> found;
    for (std::size_t at = 0; at < code.size();) {
        if (code[at] == '"') {
            at = end_of_string(code, at);
        } else if (code.substr(at, 2) == "//") {
            at = std::min(code.find('\n', at), code.size());
        } else if (in_word(code[at])) {
            const std::size_t begin = at;
            while (at < code.size() && in_word(code[at])) ++at;
            const std::string_view word = code.substr(begin, at - begin);
            const bool is_capital =
                word.size() == 1 && std::isupper(static_cast<unsigned char>(word[0])) != 0;
            if (is_capital || check::macro_elsewhere(word)) found.emplace(word);
        } else {
            ++at;
        }
    }
    return found;
}

}  // namespace

std::string shielded(const std::string& code) {
    const std::set<std::string> names = macros_in(code);
    if (names.empty()) return code;
    std::string before = "// These names are macros in some headers: they are not macros here.\n";
    std::string after = "\n";
    for (const std::string& name : names) {
        before += fmt::format("#pragma push_macro(\"{0}\")\n#undef {0}\n", name);
        after += fmt::format("#pragma pop_macro(\"{}\")\n", name);
    }
    return before + "\n" + code + after;
}

}  // namespace etlc::emit
