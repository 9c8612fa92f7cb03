// Decimal numbers as the spec writes them.
// Takes: text of the grammar's form ("-0.29", "1e-3"; "inf" and "-inf" only where a function says
// so). Gives: its exact value, its canonical text, and its float32 by one rounding (to nearest, or
// outward for ranges). Keeps true: nothing passes through binary floating point on the way.
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
    std::string digits;  ///< neither the first nor the last is 0
    std::int64_t exponent = 0;

    static Decimal parse(std::string_view text);
    static Decimal of(double value);  ///< exactly; `value` is finite

    bool is_zero() const { return digits.empty(); }
    bool is_positive() const { return !negative && !is_zero(); }
    bool is_whole() const {
        return static_cast<std::int64_t>(digits.size()) <= exponent || is_zero();
    }
    /// The value where it is a whole number in [0, limit].
    std::optional<std::uint64_t> whole(std::uint64_t limit) const;
    /// Equal values give equal texts: "0.5", "-20", "1e-9".
    std::string text() const;

    bool operator==(const Decimal&) const = default;
    std::strong_ordering operator<=>(const Decimal& other) const;
};

enum class Fit : std::uint8_t { fits, overflow, underflow };

/// The float32 nearest to the text; overflow gives an infinity, underflow a zero of a number that
/// is none.
Fit to_float(std::string_view text, float& value);
/// The double nearest to the text, infinities where it overflows.
double to_double(std::string_view text);

// Rounding outward: a number beyond all finite float32 lies between the last of them and the
// infinity.

/// The greatest float32 that is not above x.
inline float round_down(double x) {
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) > x
               ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
               : nearest;
}

/// The least float32 that is not below x.
inline float round_up(double x) {
    return -round_down(-x);
}

/// The same of a decimal text, which may be "inf" or "-inf".
float round_down(std::string_view text);
float round_up(std::string_view text);

}  // namespace etlc::check
