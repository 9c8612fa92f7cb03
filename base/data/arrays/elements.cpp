#include "data/arrays/elements.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace etlc::data {
namespace {

constexpr std::array<ElementInfo, 12> kElements{{
    {Element::f16, "f2", "float16", 2},
    {Element::f32, "f4", "float32", 4},
    {Element::f64, "f8", "float64", 8},
    {Element::i8, "i1", "int8", 1},
    {Element::i16, "i2", "int16", 2},
    {Element::i32, "i4", "int32", 4},
    {Element::i64, "i8", "int64", 8},
    {Element::u8, "u1", "uint8", 1},
    {Element::u16, "u2", "uint16", 2},
    {Element::u32, "u4", "uint32", 4},
    {Element::u64, "u8", "uint64", 8},
    {Element::boolean, "b1", "bool", 1},
}};

/// Loads an unsigned integer from its little-endian bytes.
template <class Bits>
Bits load(const char* bytes) {
    Bits result = 0;
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&result, bytes, sizeof result);
        return result;
    }
    for (std::size_t i = 0; i < sizeof(Bits); ++i)
        result = static_cast<Bits>(
            result | (static_cast<Bits>(static_cast<unsigned char>(bytes[i])) << (8 * i)));
    return result;
}

/// Converts each element by its bits. `__restrict` allows the compiler to vectorize: files have up
/// to a billion elements.
template <class Bits, class Convert>
std::size_t decode_each(const char* __restrict bytes, std::size_t n, double* __restrict to,
                        Convert convert) {
    for (std::size_t i = 0; i < n; ++i) to[i] = convert(load<Bits>(bytes + i * sizeof(Bits)));
    return n;
}

template <class Bits, class Number>
std::size_t decode_as(const char* bytes, std::size_t n, double* to) {
    return decode_each<Bits>(bytes, n, to,
                             [](Bits b) { return static_cast<double>(std::bit_cast<Number>(b)); });
}

std::size_t decode_booleans(const char* bytes, std::size_t n, double* to) {
    for (std::size_t i = 0; i < n; ++i) {
        if (bytes[i] != 0 && bytes[i] != 1) return i;
        to[i] = bytes[i];
    }
    return n;
}

}  // namespace

const ElementInfo& info(Element element) {
    return *std::find_if(kElements.begin(), kElements.end(),
                         [&](const auto& row) { return row.element == element; });
}

std::string_view name(Element element) {
    return info(element).name;
}

std::optional<Element> element_of_code(std::string_view code) {
    for (const ElementInfo& row : kElements)
        if (row.code == code) return row.element;
    return {};
}

double half_to_double(std::uint16_t bits) {
    const int exponent = (bits >> 10) & 0x1f;
    const int mantissa = bits & 0x3ff;
    double magnitude = 0;
    if (exponent == 0)
        magnitude = std::ldexp(mantissa, -24);
    else if (exponent < 0x1f)
        magnitude = std::ldexp(0x400 + mantissa, exponent - 25);
    else
        magnitude = mantissa == 0 ? std::numeric_limits<double>::infinity()
                                  : std::numeric_limits<double>::quiet_NaN();
    return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

std::size_t decode(Element element, const char* bytes, std::size_t n, double* to) {
    switch (element) {
        case Element::f16: return decode_each<std::uint16_t>(bytes, n, to, half_to_double);
        case Element::f32: return decode_as<std::uint32_t, float>(bytes, n, to);
        case Element::f64: return decode_as<std::uint64_t, double>(bytes, n, to);
        case Element::i8: return decode_as<std::uint8_t, std::int8_t>(bytes, n, to);
        case Element::i16: return decode_as<std::uint16_t, std::int16_t>(bytes, n, to);
        case Element::i32: return decode_as<std::uint32_t, std::int32_t>(bytes, n, to);
        case Element::i64: return decode_as<std::uint64_t, std::int64_t>(bytes, n, to);
        case Element::u8: return decode_as<std::uint8_t, std::uint8_t>(bytes, n, to);
        case Element::u16: return decode_as<std::uint16_t, std::uint16_t>(bytes, n, to);
        case Element::u32: return decode_as<std::uint32_t, std::uint32_t>(bytes, n, to);
        case Element::u64: return decode_as<std::uint64_t, std::uint64_t>(bytes, n, to);
        case Element::boolean: return decode_booleans(bytes, n, to);
    }
    return 0;
}

}  // namespace etlc::data
