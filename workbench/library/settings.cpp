#include "library/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "data/text/quote.hpp"

namespace etlc::library {

namespace {

/// Takes the digits that the text begins with; false where it begins with none.
bool skip_digits(std::string_view& text) {
    const std::size_t before = text.size();
    while (!text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0)
        text.remove_prefix(1);
    return text.size() < before;
}

/// The number that the text begins with, of the grammar's form, and a sign; empty where there is
/// none.
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
                                                          std::string& why) {
    std::vector<check::Setting> settings;
    for (const std::string& word : words) {
        auto setting = parse(word);
        if (!setting) {
            why = fmt::format(
                "--set takes NAME=NUMBER or NAME=DURATION, such as limit=0.25 or deadline=2s, not "
                "{}",
                data::in_quotes(word));
            return std::nullopt;
        }
        const auto again = [&](const check::Setting& s) { return s.name == setting->name; };
        if (std::any_of(settings.begin(), settings.end(), again)) {
            why = fmt::format("--set gives {} twice", data::in_quotes(setting->name));
            return std::nullopt;
        }
        settings.push_back(std::move(*setting));
    }
    return settings;
}

}  // namespace etlc::library
