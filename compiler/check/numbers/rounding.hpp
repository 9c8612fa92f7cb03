// Rounding outward: from a real number to the float32 numbers around it.
// Takes: a double, or a decimal text. Gives: the float32 next to it on one side, or itself where it
// is one. Keeps true: a number beyond all finite float32 lies between the last of them and the
// infinity.
#pragma once

#include <cmath>
#include <limits>
#include <string_view>

namespace etlc::check {

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
