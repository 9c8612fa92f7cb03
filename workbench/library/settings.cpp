#include "library/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "data/text/text.hpp"

namespace etlc::library {

namespace {

/// Skips leading digits; false where there are none.
bool skip_digits(std::string_view& text) {
    const std::size_t before = text.size();
    while (!text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0)
        text.remove_prefix(1);
    return text.size() < before;
}

/// Returns the number, with the grammar's syntax and an optional sign, at the beginning of a text.
std::string number_at_begin(std::string_view text) {
    std::string_view rest = text;
    if (rest.starts_with('-')) rest.remove_prefix(1);
    if (!skip_digits(rest)) return "";
    if (rest.starts_with('.')) {
        rest.remove_prefix(1);
        if (!skip_digits(rest)) return "";
    }
    if (rest.starts_with('e') || rest.starts_with('E')) {
        rest.remove_prefix(1);
        if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
        if (!skip_digits(rest)) return "";
    }
    return std::string(text.substr(0, text.size() - rest.size()));
}

std::optional<check::Setting> parse(const std::string& word) {
    constexpr std::array<std::string_view, 6> kUnits{"", "us", "ms", "s", "min", "steps"};
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos || sign == 0) return std::nullopt;
    check::Setting setting{word.substr(0, sign), number_at_begin(word.substr(sign + 1)), ""};
    setting.unit = word.substr(sign + 1 + setting.number.size());
    if (setting.unit.starts_with(' ')) setting.unit.erase(0, 1);
    if (setting.unit == "step") setting.unit = "steps";
    const bool fits = std::find(kUnits.begin(), kUnits.end(), setting.unit) != kUnits.end();
    return setting.number.empty() || !fits ? std::nullopt : std::optional(std::move(setting));
}

}  // namespace

std::optional<std::vector<check::Setting>> parse_settings(const std::vector<std::string>& words,
                                                          std::string_view what, std::string& why) {
    std::vector<check::Setting> settings;
    for (const std::string& word : words) {
        auto setting = parse(word);
        if (!setting) {
            why = fmt::format(
                "{} takes NAME=NUMBER or NAME=DURATION, such as limit=0.25 or deadline=2s, not {}",
                what, data::in_quotes(word));
            return std::nullopt;
        }
        const auto again = [&](const check::Setting& s) { return s.name == setting->name; };
        if (std::any_of(settings.begin(), settings.end(), again)) {
            why = fmt::format("{} gives {} twice", what, data::in_quotes(setting->name));
            return std::nullopt;
        }
        settings.push_back(std::move(*setting));
    }
    return settings;
}

namespace {

constexpr std::uint32_t kMostIncidents = 1'000'000;

/// Parses a number of steps or a duration: "40", "2s" or "1.5 min".
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

std::optional<plan::RecorderRequest> request(std::string_view text) {
    const std::size_t first = text.find(',');
    const std::size_t second = first == text.npos ? text.npos : text.find(',', first + 1);
    if (second == text.npos) return std::nullopt;
    const auto before = length(text.substr(0, first));
    const auto after = length(text.substr(first + 1, second - first - 1));
    const auto number = data::parse_whole<std::uint32_t>(text.substr(second + 1));
    if (!before || !after || !number || *number < 1 || *number > kMostIncidents)
        return std::nullopt;
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
