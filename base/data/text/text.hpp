// Numbers in text, and words in quotes.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace etlc::data {

// Numbers in files and calls, whatever the locale.

/// Parses a decimal number that is all of `text`, as the nearest double. `nan`, `inf` and
/// `infinity` in any case are numbers that are not finite; what is too large for a double is
/// infinite, what is too small is zero.
std::optional<double> parse_number(std::string_view text);

/// Parses a whole number in decimal digits that is all of `text` and fits the type.
template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
    Number value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

/// "q" and 3 of "q[3]".
struct ElementName {
    std::string array;
    std::optional<std::uint32_t> element;  ///< nothing: the name has no brackets
};

/// Splits the name of an element of an array; any other name is that of an array.
ElementName element_name(std::string_view name);

// Text from files, quoted for messages: control characters and broken UTF-8 escaped, long text cut
// short. Keeps true: a hostile file cannot send terminal escapes or megabytes through a diagnostic.

/// Quotes a text: 'text'.
std::string in_quotes(std::string_view text);

/// Lists names: 'a', 'b' and 'c'; for a long list the first few and a count.
std::string listed(const std::vector<std::string>& names);

/// Returns "; did you mean 'goal'?" where a candidate is near the name, else nothing.
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace etlc::data
