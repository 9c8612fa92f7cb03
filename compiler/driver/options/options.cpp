#include "driver/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "data/quote.hpp"
#include "diag/diag.hpp"

namespace etlc::driver {

std::string mistake_in_word(const std::string& found, const std::vector<std::string>& expected) {
    if (std::find(expected.begin(), expected.end(), found) != expected.end()) return "";
    const auto meant = diag::nearest_name(found, expected);
    return fmt::format("found {}, expected {}{}", data::in_quotes(found),
                       diag::alternatives(expected),
                       meant ? fmt::format("; did you mean '{}'?", *meant) : "");
}

std::string mistake_in_number(const std::string& found, std::uint64_t least, std::uint64_t most) {
    std::uint64_t number = 0;
    const char* end = found.data() + found.size();
    const auto [stop, error] = std::from_chars(found.data(), end, number);
    if (error == std::errc() && stop == end && least <= number && number <= most) return "";
    const bool bounded = most < std::numeric_limits<std::uint64_t>::max();
    return fmt::format("found {}, expected a whole number from {}{}", data::in_quotes(found), least,
                       bounded ? fmt::format(" to {}", most) : "");
}

std::string mistake_in_reason(const std::string& found) {
    constexpr std::size_t kLongest = 200;
    const bool has_words = std::any_of(found.begin(), found.end(),
                                       [](unsigned char c) { return std::isalnum(c) != 0; });
    const bool one_line = found.find_first_of("\n\r") == std::string::npos;
    if (has_words && one_line && found.size() <= kLongest) return "";
    return fmt::format("found {}, expected a reason in words, on one line of at most {} bytes",
                       data::in_quotes(found), kLongest);
}

namespace {

constexpr std::uint64_t kMostIncidents = 1'000'000;

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

std::optional<plan::RecorderRequest> parse_recorder(std::string_view text) {
    const std::size_t first = text.find(',');
    const std::size_t second = first == text.npos ? text.npos : text.find(',', first + 1);
    if (second == text.npos) return std::nullopt;
    const auto before = length(text.substr(0, first));
    const auto after = length(text.substr(first + 1, second - first - 1));
    const std::string incidents(text.substr(second + 1));
    if (!before || !after || !mistake_in_number(incidents, 1, kMostIncidents).empty())
        return std::nullopt;
    return plan::RecorderRequest{*before, *after,
                                 static_cast<std::uint32_t>(std::stoul(incidents))};
}

}  // namespace

std::string mistake_in_recorder(const std::string& found) {
    if (parse_recorder(found)) return "";
    return fmt::format(
        "found {}, expected BEFORE,AFTER,INCIDENTS: two durations or numbers of "
        "steps, and how many incidents, as 2s,1s,4 or 40,20,4",
        data::in_quotes(found));
}

plan::RecorderRequest recorder(const std::string& text) {
    return *parse_recorder(text);
}

CLI::Validator one_of(std::vector<std::string> words) {
    const std::string form = fmt::format("{}", fmt::join(words, "|"));
    return CLI::Validator(
        [words = std::move(words)](std::string& found) { return mistake_in_word(found, words); },
        form);
}

}  // namespace etlc::driver
