#include "check/numbers/duration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "check/numbers/bounds.hpp"

namespace etlc::check {

namespace {

__extension__ using Wide = unsigned __int128;

/// numerator / denominator x 10^exponent.
struct Fraction {
    Wide numerator = 0;
    Wide denominator = 1;
    std::int64_t exponent = 0;
};

/// Mantissa, below 10^18, and power of ten.
struct Scaled {
    std::uint64_t mantissa = 0;
    std::int64_t exponent = 0;
};

Scaled scaled(const Decimal& value) {
    if (value.is_zero()) return {};
    return {std::strtoull(value.digits.c_str(), nullptr, 10),
            value.exponent - static_cast<std::int64_t>(value.digits.size())};
}

std::int64_t power_of_unit(std::string_view unit) {
    return unit == "us" ? -6 : unit == "ms" ? -3 : 0;
}

/// `time` / `step`, or time x rate. Minutes over minutes cancel first, so that the products stay
/// below 2^128: the numerator is at most 60 x 10^36, and the denominator at most 60 x 10^18.
Fraction quotient(const Quantity& time, const Quantity& step) {
    const Scaled t = scaled(time.value);
    const Scaled s = scaled(step.value);
    const bool cancel = time.unit == "min" && step.unit == "min";
    Fraction result{t.mantissa, 1, t.exponent + power_of_unit(time.unit)};
    if (time.unit == "min" && !cancel) result.numerator *= 60;
    if (step.unit == "Hz") {
        result.numerator *= s.mantissa;
        result.exponent += s.exponent;
        return result;
    }
    result.denominator = s.mantissa;
    if (step.unit == "min" && !cancel) result.denominator *= 60;
    result.exponent -= s.exponent + power_of_unit(step.unit);
    return result;
}

Wide gcd(Wide a, Wide b) {
    while (b != 0) a = std::exchange(b, a % b);
    return a;
}

std::string digits_of(Wide value) {
    std::string text;
    do text += static_cast<char>('0' + static_cast<int>(value % 10));
    while ((value /= 10) != 0);
    std::reverse(text.begin(), text.end());
    return text;
}

bool multiply(Wide& value, Wide factor) {
    if (value != 0 && factor > ~Wide{0} / value) return false;
    value *= factor;
    return true;
}

/// The fraction as a decimal, where one of moderate length is equal to it.
std::string decimal_text(Fraction x) {
    const Wide common = gcd(x.numerator, x.denominator);
    x.numerator /= common;
    x.denominator /= common;
    for (; x.denominator % 10 == 0; x.denominator /= 10) --x.exponent;
    for (const auto& [prime, cofactor] : {std::pair<Wide, Wide>{2, 5}, {5, 2}})
        for (; x.denominator % prime == 0; x.denominator /= prime, --x.exponent)
            if (!multiply(x.numerator, cofactor)) return {};
    if (x.denominator != 1) return {};
    return Decimal::parse(digits_of(x.numerator) + "e" + std::to_string(x.exponent)).text();
}

/// The fraction as "100/3", where its terms are of moderate length.
std::string fraction_text(Fraction x) {
    if (std::abs(x.exponent) > 38) return {};
    for (; x.exponent > 0; --x.exponent)
        if (!multiply(x.numerator, 10)) return {};
    for (; x.exponent < 0; ++x.exponent)
        if (!multiply(x.denominator, 10)) return {};
    const Wide common = gcd(x.numerator, x.denominator);
    return digits_of(x.numerator / common) + "/" + digits_of(x.denominator / common);
}

}  // namespace

StepCount count_steps(const Quantity& duration, const Quantity& step) {
    Fraction x = quotient(duration, step);
    if (x.numerator == 0) return {.whole = true};
    for (; x.exponent > 0; --x.exponent) {
        if (x.numerator / x.denominator > kMaxBound) return {.too_many = true};
        x.numerator *= 10;  // below 2^32 x denominator x 10
    }
    for (; x.exponent < 0; ++x.exponent) {
        if (x.numerator % 10 == 0)
            x.numerator /= 10;
        else if (!multiply(x.denominator, 10))
            return {};  // a denominator that does not fit exceeds the numerator
    }
    const Wide floor = x.numerator / x.denominator;
    if (floor > kMaxBound) return {.too_many = true};
    const Wide rest = x.numerator % x.denominator;
    if (rest != 0 && floor == kMaxBound) return {.too_many = true};
    return {.floor = static_cast<std::uint64_t>(floor),
            .whole = rest == 0,
            .upper_half = rest >= x.denominator - rest};
}

std::string with_unit(std::string_view number, std::string_view unit) {
    return fmt::format("{}{}{}", number, unit.empty() ? "" : " ", unit);
}

std::string duration_text(std::uint64_t steps, const Quantity& step, std::string_view unit) {
    // steps x step / unit = steps / (one unit / step)
    const Fraction per_unit = quotient({Decimal::parse("1"), unit}, step);
    const Fraction x{per_unit.denominator * steps, per_unit.numerator, -per_unit.exponent};
    std::string text = decimal_text(x);
    if (text.empty()) text = fraction_text(x);
    if (text.empty())
        text = fmt::format("about {:.6g}", static_cast<double>(steps) * seconds(step) /
                                               seconds({Decimal::parse("1"), unit}));
    return text + " " + std::string(unit);
}

double seconds(const Quantity& step) {
    const double value = to_double(step.value.text());
    if (step.unit == "Hz") return 1.0 / value;
    if (step.unit == "us") return value / 1e6;
    if (step.unit == "ms") return value / 1e3;
    return step.unit == "min" ? value * 60.0 : value;
}

}  // namespace etlc::check
