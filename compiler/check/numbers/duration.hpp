// Exact decimal fractions of time.
// Takes: a duration and a rate or period, each a decimal of at most kMaxTimeDigits significant
// digits with a unit. Gives: how many steps the duration is, or between which two numbers of steps
// it lies. Keeps true: integer arithmetic of 128 bits that cannot overflow for such numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

inline constexpr std::size_t kMaxTimeDigits = 18;

/// A positive or zero time, or a rate: `value` in `unit` (us, ms, s, min, Hz).
struct Quantity {
    Decimal value;
    std::string_view unit;
};

struct StepCount {
    std::uint64_t floor = 0;  ///< of the exact quotient
    bool whole = false;
    bool upper_half = false;  ///< the quotient is floor + 1/2 or more
    bool too_many = false;    ///< more than kMaxBound; `floor` is then unset
};

StepCount count_steps(const Quantity& duration, const Quantity& step);

/// "0.5 s"; the number alone where there is no unit.
std::string with_unit(std::string_view number, std::string_view unit);

/// `steps` steps as a duration in `unit`: "0.15 s", or "100/3 ms" where no decimal is equal to it.
std::string duration_text(std::uint64_t steps, const Quantity& step, std::string_view unit);

/// The length of a step in seconds, rounded to double.
double seconds(const Quantity& step);

}  // namespace etlc::check
