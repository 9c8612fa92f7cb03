#include "prove/text/members.hpp"

#include <regex>

namespace etlc::prove {

std::string with_counters(const std::string& header) {
    static const std::regex kMember(R"(\buint32_t (\w*position_)\{\};)");
    static const std::regex kAdvance(
        R"(\bif \((\w*position_) != UINT32_MAX\) \{\s*\+\+(\w*position_);\s*\})");
    std::string result;
    std::string rest = std::regex_replace(header, kMember, "etlprove::Counter $1{};");
    for (std::smatch match; std::regex_search(rest, match, kAdvance); rest = match.suffix()) {
        result += match.prefix();
        result += match[1] == match[2] ? "{ " + match[1].str() + ".advance(); }" : match[0].str();
    }
    return result + rest;
}

bool may_hide_state(const std::string& header) {
    static const std::regex kComment(R"(//[^\n]*)");
    // What is constant, and functions, which a body follows.
    static const std::regex kHarmless(R"(\b(static|inline)\s+(constexpr\b|namespace\b|)"
                                      R"([^;={}(]*\([^;{}]*\)\s*(const\s*)?noexcept\s*\{))");
    static const std::regex kSuspect(R"(\b(static|inline|extern|thread_local|volatile|mutable)\b)");
    // Of what stands in no braces, what ends within its line.
    static const std::regex kVariable(R"(\n(?!using |static_assert\(|constexpr )\w[^\n]*;)");
    const std::string code =
        std::regex_replace(std::regex_replace(header, kComment, ""), kHarmless, "");
    return std::regex_search(code, kSuspect) || std::regex_search(code, kVariable);
}

}  // namespace etlc::prove
