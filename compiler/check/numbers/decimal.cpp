#include "check/numbers/decimal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include "check/numbers/range.hpp"

namespace etlc::check {

namespace {

constexpr std::int64_t kExponentLimit = std::int64_t{1} << 40;
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

std::int64_t parse_exponent(std::string_view text) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    std::int64_t value = 0;
    for (const char c : text) value = std::min(kExponentLimit, value * 10 + (c - '0'));
    return negative ? -value : value;
}

/// Limits on the digits before and after the point; longer numbers have an exponent.
constexpr std::int64_t kPlainDigits = 21;
constexpr std::int64_t kPlainZeros = 6;

template <class T>
Fit nearest(std::string_view text, T& value) {
    const Decimal exact = Decimal::parse(text);
    value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool huge = result.ec == std::errc::result_out_of_range && exact.exponent > 0;
    if (huge || std::isinf(value)) {
        value = exact.negative ? -std::numeric_limits<T>::infinity()
                               : std::numeric_limits<T>::infinity();
        return Fit::overflow;
    }
    if (result.ec != std::errc() || value == 0) {
        value = 0;  // also for -0, which has the same robustness
        return exact.is_zero() ? Fit::fits : Fit::underflow;
    }
    return Fit::fits;
}

}  // namespace

Decimal Decimal::parse(std::string_view text) {
    Decimal result;
    result.negative = text.starts_with('-');
    if (result.negative) text.remove_prefix(1);
    const std::size_t e = text.find_first_of("eE");
    if (e != std::string_view::npos) {
        result.exponent = parse_exponent(text.substr(e + 1));
        text = text.substr(0, e);
    }
    const std::size_t point = text.find('.');
    result.exponent += static_cast<std::int64_t>(std::min(point, text.size()));
    for (const char c : text)
        if (c != '.') result.digits += c;
    const std::size_t first = std::min(result.digits.find_first_not_of('0'), result.digits.size());
    result.digits.erase(0, first);
    result.exponent -= static_cast<std::int64_t>(first);
    result.digits.erase(result.digits.find_last_not_of('0') + 1);
    if (result.is_zero()) result = {};
    return result;
}

Decimal Decimal::of(double value) {
    std::array<char, 1200> buffer;  // a double has at most 767 significant digits
    char* const last = buffer.data() + buffer.size();
    constexpr double kWhole = 1e15;  // whole numbers up to it are common, and have few digits
    const bool is_short = std::abs(value) < kWhole && value == std::trunc(value);
    const auto end =
        is_short ? std::to_chars(buffer.data(), last, static_cast<std::int64_t>(value))
                 : std::to_chars(buffer.data(), last, value, std::chars_format::scientific, 800);
    return parse({buffer.data(), static_cast<std::size_t>(end.ptr - buffer.data())});
}

std::optional<std::uint64_t> Decimal::whole(std::uint64_t limit) const {
    if (negative || !is_whole() || exponent > 20) return std::nullopt;
    std::string text = "0" + digits;
    text.resize(static_cast<std::size_t>(exponent) + 1, '0');
    std::uint64_t value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    return result.ec == std::errc() && value <= limit ? std::optional(value) : std::nullopt;
}

std::string Decimal::text() const {
    if (is_zero()) return "0";
    std::string text = negative ? "-" : "";
    const auto size = static_cast<std::int64_t>(digits.size());
    if (exponent > kPlainDigits || exponent < -kPlainZeros) {
        text += digits[0];
        if (size > 1) text.append(".").append(digits, 1);
        return text.append("e").append(std::to_string(exponent - 1));
    }
    if (exponent <= 0)
        return text.append("0.").append(static_cast<std::size_t>(-exponent), '0').append(digits);
    const auto point = static_cast<std::size_t>(exponent);
    if (size <= exponent) return text.append(digits).append(point - digits.size(), '0');
    return text.append(digits, 0, point).append(".").append(digits, point);
}

std::strong_ordering Decimal::operator<=>(const Decimal& other) const {
    const auto sign = [](const Decimal& x) { return x.is_zero() ? 0 : x.negative ? -1 : 1; };
    if (sign(*this) != sign(other)) return sign(*this) <=> sign(other);
    const auto magnitude = [](const Decimal& x) { return std::tie(x.exponent, x.digits); };
    return negative ? magnitude(other) <=> magnitude(*this) : magnitude(*this) <=> magnitude(other);
}

Fit to_float(std::string_view text, float& value) {
    return nearest(text, value);
}

double to_double(std::string_view text) {
    double value = 0;
    nearest(text, value);
    return value;
}

namespace {

float rounded(std::string_view text, float towards) {
    if (text == "inf") return kFloatInfinity;
    if (text == "-inf") return -kFloatInfinity;
    float value = 0;
    to_float(text, value);
    if (value == towards) return value;
    if (std::isinf(value)) return std::nextafter(value, towards);
    const auto order = Decimal::of(static_cast<double>(value)) <=> Decimal::parse(text);
    const bool beyond = towards < 0 ? order > 0 : order < 0;
    return beyond ? std::nextafter(value, towards) : value;
}

}  // namespace

float round_down(std::string_view text) {
    return rounded(text, -kFloatInfinity);
}

float round_up(std::string_view text) {
    return rounded(text, kFloatInfinity);
}

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
