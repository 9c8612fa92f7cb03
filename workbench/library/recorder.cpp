#include "library/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "data/text/quote.hpp"

namespace etlc::library {

namespace {

constexpr std::uint32_t kMostIncidents = 1'000'000;

/// "40", "2s" or "1.5 min"; nothing where it is neither steps nor a duration.
std::optional<plan::Length> length(std::string_view text) {
    plan::Length result{.text = std::string(text)};
    const char* end = text.data() + text.size();
    const auto [stop, error] =
        std::from_chars(text.data(), end, result.number, std::chars_format::fixed);
    if (error != std::errc() || !std::isfinite(result.number) || std::signbit(result.number))
        return std::nullopt;
    std::string_view unit(stop, static_cast<std::size_t>(end - stop));
    if (unit.empty())
        return result.number == std::floor(result.number) ? std::optional(result) : std::nullopt;
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const std::pair<std::string_view, double> units[] = {
        {"us", 1e-6}, {"ms", 1e-3}, {"s", 1}, {"min", 60}};
    for (const auto& [name, seconds] : units)
        if (unit == name) {
            result.number *= seconds;
            result.in_seconds = true;
            return result;
        }
    return std::nullopt;
}

/// In decimal digits.
std::optional<std::uint32_t> incidents(std::string_view text) {
    std::uint32_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    const bool fits = error == std::errc() && stop == end && 1 <= number;
    return fits && number <= kMostIncidents ? std::optional(number) : std::nullopt;
}

std::optional<plan::RecorderRequest> request(std::string_view text) {
    const std::size_t first = text.find(',');
    const std::size_t second = first == text.npos ? text.npos : text.find(',', first + 1);
    if (second == text.npos) return std::nullopt;
    const auto before = length(text.substr(0, first));
    const auto after = length(text.substr(first + 1, second - first - 1));
    const auto number = incidents(text.substr(second + 1));
    if (!before || !after || !number) return std::nullopt;
    return plan::RecorderRequest{*before, *after, *number};
}

}  // namespace

std::optional<plan::RecorderRequest> parse_recorder(std::string_view text, std::string& why) {
    auto found = request(text);
    if (!found)
        why = fmt::format(
            "found {}, expected BEFORE,AFTER,INCIDENTS: two durations or numbers of "
            "steps, and how many incidents, as 2s,1s,4 or 40,20,4",
            data::in_quotes(std::string(text)));
    return found;
}

}  // namespace etlc::library
