// Exact decimal numbers in the form of the grammar ("-0.29", "1e-3"; "inf" and "-inf" where a
// function says so), and their rounding to float32 in one step, to nearest or outward.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace etlc::check {

/// The exact value 0.DIGITS x 10^exponent; zero has no digits, no sign and exponent 0.
struct Decimal {
    bool negative = false;
    std::string digits;  ///< without leading or trailing zeros
    std::int64_t exponent = 0;

    static Decimal parse(std::string_view text);
    static Decimal of(double value);  ///< exact; `value` is finite

    bool is_zero() const { return digits.empty(); }
    bool is_positive() const { return !negative && !is_zero(); }
    bool is_whole() const {
        return static_cast<std::int64_t>(digits.size()) <= exponent || is_zero();
    }
    /// Returns the value if it is a whole number in [0, limit].
    std::optional<std::uint64_t> whole(std::uint64_t limit) const;
    /// Returns the same text for equal values: "0.5", "-20", "1e-9".
    std::string text() const;

    bool operator==(const Decimal&) const = default;
    std::strong_ordering operator<=>(const Decimal& other) const;
};

enum class Fit : std::uint8_t { fits, overflow, underflow };

/// Sets the nearest float32: infinity on overflow, zero on underflow.
Fit to_float(std::string_view text, float& value);
/// Returns the nearest double, infinity on overflow.
double to_double(std::string_view text);

// Rounding outward: numbers beyond all finite float32 lie between the last of them and infinity.

/// Returns the greatest float32 that is not above x.
inline float round_down(double x) {
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) > x
               ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
               : nearest;
}

/// Returns the least float32 that is not below x.
inline float round_up(double x) {
    return -round_down(-x);
}

/// The text is a decimal, "inf" or "-inf".
float round_down(std::string_view text);
float round_up(std::string_view text);

// Exact arithmetic on times, in integers of 128 bits that cannot overflow for decimals of at most
// kMaxTimeDigits significant digits.

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
