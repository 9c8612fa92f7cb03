// JSON as Python writes it: NaN, Infinity and -Infinity are no JSON, and stand for null. Files of
// values, one a line; lines of blanks are passed over.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "diag/diag.hpp"

namespace etlc::data {

/// Discarded where it is no JSON.
nlohmann::json parse_json(std::string_view text);

/// Calls `visit(line, json)` for each, lines counted from 1; of one that is no JSON `json` is
/// discarded. Ends with the first failure that it gives.
template <class Visit>
std::optional<diag::Failure> for_each_json_line(std::string_view text, const Visit& visit) {
    std::uint32_t line = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view words = text.substr(at, end - at);
        at = end + 1;
        ++line;
        if (words.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        std::optional<diag::Failure> failure = visit(line, parse_json(words));
        if (failure) return failure;
    }
    return std::nullopt;
}

}  // namespace etlc::data
