// Exact arithmetic on times, in integers of 128 bits that cannot overflow for decimals of at most
// kMaxTimeDigits significant digits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

inline constexpr std::size_t kMaxTimeDigits = 18;

/// A time of at least zero, or a rate: `value` in `unit` (us, ms, s, min, Hz).
struct Quantity {
    Decimal value;
    std::string_view unit;
};

struct StepCount {
    std::uint64_t floor = 0;  ///< of the exact quotient
    bool whole = false;
    bool upper_half = false;  ///< the fractional part is 1/2 or more
    bool too_many = false;    ///< more than kMaxBound; `floor` is not set
};

StepCount count_steps(const Quantity& duration, const Quantity& step);

/// Returns "0.5 s", or only the number if there is no unit.
std::string with_unit(std::string_view number, std::string_view unit);

/// Returns `steps` steps as a duration in `unit`: "0.15 s", or "100/3 ms" if no decimal is equal.
std::string duration_text(std::uint64_t steps, const Quantity& step, std::string_view unit);

/// Returns the length of a step in seconds, rounded to double.
double seconds(const Quantity& step);

}  // namespace etlc::check
