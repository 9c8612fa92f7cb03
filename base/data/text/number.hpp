// Decimal numbers in data files, whatever the locale.
// Takes: the whole text of a cell. Gives: the nearest double. Keeps true: `nan`, `inf` and
// `infinity` in any case are numbers that are not finite; what is too large for a double is
// infinite, what is too small is zero.
#pragma once

#include <optional>
#include <string_view>

namespace etlc::data {

/// Nothing where `text` is not one number from end to end.
std::optional<double> parse_number(std::string_view text);

}  // namespace etlc::data
