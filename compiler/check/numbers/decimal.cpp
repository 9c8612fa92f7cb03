#include "check/numbers/decimal.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <tuple>

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

}  // namespace etlc::check
