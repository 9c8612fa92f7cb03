#include "prove/text/code.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

#include "prove/text/cones.hpp"

namespace etlc::prove::code {
namespace {

using Names = std::set<std::string>;

bool is_part_of_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Words that no statement of the class writes.
const Names kWords = {"const",   "static",     "constexpr", "bool",   "float",   "int",
                      "uint8_t", "auto",       "uint32_t",  "Value",  "return",  "if",
                      "for",     "else",       "true",      "false",  "nullptr", "using",
                      "Reading", "UINT32_MAX", "in",        "Inputs", "noexcept"};

/// Functions that do not write what they are given, and methods that do not change their object.
const Names kPure = {"min_of",  "max_of", "negate",      "max_in",         "min_in",
                     "exists",  "push",   "static_cast", "prefix_verdict", "sliding_verdict",
                     "at",      "if",     "truth_of",    "Verdicts",       "BooleanVerdict",
                     "present", "value",  "data",        "reset",          "accept",
                     "Flag",    "Inputs"};
const Names kConst = {"final",   "alarm", "satisfied", "violated", "unknown",
                      "decided", "value", "present",   "data",     "at"};

}  // namespace

std::string without_comments(std::string_view text) {
    std::string result;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text.substr(at, 2) == "//") at = std::min(text.find('\n', at), text.size() - 1);
        result += text[at];
    }
    return result;
}

std::size_t closing(std::string_view text, std::size_t open) {
    int depth = 0;
    for (std::size_t at = open; at < text.size(); ++at) {
        if (text[at] == '(' || text[at] == '{' || text[at] == '[') ++depth;
        if (text[at] == ')' || text[at] == '}' || text[at] == ']') --depth;
        if (depth == 0) return at;
    }
    throw Unreadable{"a bracket that is not closed"};
}

std::size_t skip_space(std::string_view text, std::size_t at) {
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) ++at;
    return at;
}

std::string_view name_at(std::string_view text, std::size_t at) {
    if (at >= text.size() || std::isdigit(static_cast<unsigned char>(text[at])) != 0) return {};
    std::size_t end = at;
    while (end < text.size() && is_part_of_name(text[end])) ++end;
    return text.substr(at, end - at);
}

std::vector<Found> names_in(std::string_view text) {
    std::vector<Found> found;
    for (std::size_t at = 0; at < text.size();) {
        const bool is_within = at > 0 && is_part_of_name(text[at - 1]);
        std::string_view name = is_within ? std::string_view() : name_at(text, at);
        if (name.empty()) {
            ++at;
            continue;
        }
        const std::size_t end = at + name.size();
        if (name == "answers_" && end < text.size() && text[end] == '.')
            name = text.substr(at, name.size() + 1 + name_at(text, end + 1).size());
        const std::size_t after = at + name.size();
        const bool is_elsewhere = (at > 0 && text[at - 1] == '.') ||
                                  text.substr(0, at).ends_with("::") ||
                                  text.substr(after).starts_with("::");
        if (!is_elsewhere && !kWords.contains(std::string(name)))
            found.push_back({std::string(name), at, after});
        at = after;
    }
    return found;
}

namespace {

/// Returns the functions in whose arguments a place is.
std::vector<std::string> calls_around(std::string_view text, std::size_t place) {
    std::vector<std::string> calls;
    for (std::size_t at = 0; at < place; ++at) {
        if (text[at] != '(' || closing(text, at) < place) continue;
        std::size_t end = at;
        if (end > 0 && text[end - 1] == '>') end = text.rfind('<', end);
        std::size_t begin = end;
        while (begin > 0 && is_part_of_name(text[begin - 1])) --begin;
        if (begin != end) calls.emplace_back(text.substr(begin, end - begin));
    }
    return calls;
}

}  // namespace

bool is_written(std::string_view text, const Found& found) {
    std::size_t before = found.begin;
    while (before > 0 && std::isspace(static_cast<unsigned char>(text[before - 1])) != 0) --before;
    const std::string_view ahead = text.substr(0, before);
    if (ahead.ends_with("++") || ahead.ends_with("--")) return true;
    if (ahead.ends_with("&") && !ahead.ends_with("&&")) return true;
    std::size_t at = skip_space(text, found.end);
    while (at < text.size() && (text[at] == '[' || text[at] == '.')) {
        if (text[at] == '[') {
            at = skip_space(text, closing(text, at) + 1);
            continue;
        }
        const std::string_view field = name_at(text, at + 1);
        at = skip_space(text, at + 1 + field.size());
        if (at < text.size() && text[at] == '(') return !kConst.contains(std::string(field));
    }
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("++") || rest.starts_with("--")) return true;
    static const std::regex kAssigns(R"(^([-+*/|&^%]|<<|>>)?=([^=]|$))");
    if (std::regex_search(rest.begin(), rest.end(), kAssigns)) return true;
    const std::vector<std::string> calls = calls_around(text, found.begin);
    return std::any_of(calls.begin(), calls.end(),
                       [](const std::string& call) { return !kPure.contains(call); });
}

bool makes_reference(std::string_view text) {
    static const std::regex kReference(R"(^\s*(const\s+)?[\w:<>]+\s*[&*]\s*(const\s+)?\w+\s*=)");
    return std::regex_search(text.begin(), text.end(), kReference);
}

}  // namespace etlc::prove::code
