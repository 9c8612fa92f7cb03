#include "data/datasets/json_lines.hpp"

#include <array>
#include <string>

namespace etlc::data {
namespace {

/// With null in place of the numbers that JSON does not have, outside of strings.
std::string with_nulls(std::string_view text) {
    constexpr std::array<std::string_view, 3> kNumbers = {"NaN", "Infinity", "-Infinity"};
    std::string result;
    bool in_string = false;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t taken = in_string && text[at] == '\\' ? 2 : 1;
        if (text[at] == '"') in_string = !in_string;
        std::string_view piece = text.substr(at, taken);
        for (const std::string_view number : kNumbers)
            if (!in_string && text.substr(at).starts_with(number)) {
                piece = "null";
                taken = number.size();
                break;
            }
        result += piece;
        at += taken;
    }
    return result;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_discarded()) return json;
    return nlohmann::json::parse(with_nulls(text), nullptr, false);
}

}  // namespace etlc::data
