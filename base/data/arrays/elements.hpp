// The element types of arrays: their names, and the conversion of their bytes to numbers.
// Takes: little-endian bytes as in .npy files. Gives: doubles.
// Keeps true: every float16, float32 and integer up to 2^53 converts exactly.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "data/arrays/array.hpp"

namespace etlc::data {

struct ElementInfo {
    Element element;
    std::string_view code;  ///< the descr of .npy files without its byte order: "f4"
    std::string_view name;  ///< the name in numpy: "float32"
    std::uint32_t bytes;
};

const ElementInfo& info(Element element);
/// Returns the element type with this code, "f4".
std::optional<Element> element_of_code(std::string_view code);

/// Converts IEEE 754 binary16 to double, exactly, NaN and infinities included.
double half_to_double(std::uint16_t bits);

/// Converts `n` elements. Returns how many are valid: fewer than `n` where a boolean byte is
/// neither 0 nor 1.
std::size_t decode(Element element, const char* bytes, std::size_t n, double* to);

}  // namespace etlc::data
