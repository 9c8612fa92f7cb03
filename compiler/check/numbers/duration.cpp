#include "check/numbers/duration.hpp"

#include <fmt/format.h>

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

/// Reduces the fraction to lowest terms, apart from the power of ten.
Fraction reduced(const Fraction& x) {
    Wide common = x.numerator;
    for (Wide rest = x.denominator; rest != 0;) common = std::exchange(rest, common % rest);
    return {x.numerator / common, x.denominator / common, x.exponent};
}

/// Returns the quantity in s or Hz; its numerator is at most 60 x 10^18.
Fraction fraction_of(const Quantity& q) {
    const std::uint64_t mantissa = std::strtoull(q.value.digits.c_str(), nullptr, 10);
    const int power = q.unit == "us" ? -6 : q.unit == "ms" ? -3 : 0;
    return {Wide{mantissa} * (q.unit == "min" ? 60 : 1), 1,
            q.value.exponent - static_cast<std::int64_t>(q.value.digits.size()) + power};
}

/// Returns `time` / `step`, or time x rate; products stay below 2^128.
Fraction quotient(const Quantity& time, const Quantity& step) {
    const Fraction t = fraction_of(time);
    const Fraction s = fraction_of(step);
    if (step.unit == "Hz") return {t.numerator * s.numerator, 1, t.exponent + s.exponent};
    return reduced({t.numerator, s.numerator, t.exponent - s.exponent});
}

std::string digits_of(Wide value) {
    std::string text;
    do text.insert(text.begin(), static_cast<char>('0' + static_cast<int>(value % 10)));
    while ((value /= 10) != 0);
    return text;
}

bool multiply(Wide& value, Wide factor) {
    if (value != 0 && factor > ~Wide{0} / value) return false;
    value *= factor;
    return true;
}

/// Returns an equal decimal of moderate length, if there is one.
std::string decimal_text(Fraction x) {
    for (const auto& [divisor, cofactor] : {std::pair<Wide, Wide>{10, 1}, {2, 5}, {5, 2}})
        for (; x.denominator % divisor == 0; x.denominator /= divisor, --x.exponent)
            if (!multiply(x.numerator, cofactor)) return {};
    if (x.denominator != 1) return {};
    return Decimal::parse(digits_of(x.numerator) + "e" + std::to_string(x.exponent)).text();
}

/// Returns "100/3" if the terms have moderate length.
std::string fraction_text(Fraction x) {
    if (std::abs(x.exponent) > 38) return {};
    for (; x.exponent != 0; x.exponent += x.exponent < 0 ? 1 : -1)
        if (!multiply(x.exponent < 0 ? x.denominator : x.numerator, 10)) return {};
    x = reduced(x);
    return digits_of(x.numerator) + "/" + digits_of(x.denominator);
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
            return {};  // the denominator would exceed the numerator
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
    const Fraction x =
        reduced({per_unit.denominator * steps, per_unit.numerator, -per_unit.exponent});
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
