#include "data/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "diag/diag.hpp"
#include "source/text.hpp"

namespace etlc::data {

namespace {

/// Returns whether a decimal number out of the range of double is too large, not too small.
bool too_large(std::string_view digits) {
    // The decimal exponent: the place of the first digit that is not zero, plus the exponent.
    const std::size_t e = digits.find_first_of("eE");
    const std::string_view mantissa = digits.substr(0, e);
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const std::size_t first = mantissa.find_first_of("123456789");
    const double place = static_cast<double>(point) - static_cast<double>(first);
    if (e == std::string_view::npos) return place > 0;
    std::string_view exponent = digits.substr(e + 1);
    const bool negative = exponent.starts_with('-');
    if (negative || exponent.starts_with('+')) exponent.remove_prefix(1);
    long value = 0;
    const auto [end, error] =
        std::from_chars(exponent.data(), exponent.data() + exponent.size(), value);
    if (error != std::errc()) value = std::numeric_limits<long>::max();
    return place + static_cast<double>(negative ? -value : value) > 0;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return {};
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::invalid_argument || end != text.data() + text.size()) return {};
    if (error == std::errc()) return value;
    const bool negative = text.starts_with('-');
    const double magnitude =
        too_large(text.substr(negative ? 1 : 0)) ? std::numeric_limits<double>::infinity() : 0.0;
    return negative ? -magnitude : magnitude;
}

ElementName element_name(std::string_view name) {
    const std::size_t open = name.find('[');
    if (open == std::string_view::npos || !name.ends_with(']')) return {std::string(name), {}};
    const auto element = parse_whole<std::uint32_t>(name.substr(open + 1, name.size() - open - 2));
    return {std::string(element ? name.substr(0, open) : name), element};
}

namespace {

constexpr std::size_t kMaxQuoted = 60;  ///< bytes
constexpr std::size_t kMaxListed = 10;

}  // namespace

std::string in_quotes(std::string_view text) {
    if (text.size() <= kMaxQuoted) return fmt::format("'{}'", source::visible(text));
    std::size_t cut = kMaxQuoted;
    while (cut > kMaxQuoted - 4 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;
    return fmt::format("'{}...'", source::visible(text.substr(0, cut)));
}

std::string listed(const std::vector<std::string>& names) {
    std::string result;
    const std::size_t shown = std::min(names.size(), kMaxListed);
    const std::size_t hidden = names.size() - shown;
    for (std::size_t i = 0; i < shown; ++i) {
        if (i > 0) result += i + 1 == shown && hidden == 0 ? " and " : ", ";
        result += in_quotes(names[i]);
    }
    if (hidden > 0) result += fmt::format(" and {} more", hidden);
    return result;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
    const auto nearest = diag::nearest_name(name, candidates);
    return nearest ? fmt::format("; did you mean {}?", in_quotes(*nearest)) : "";
}

}  // namespace etlc::data
