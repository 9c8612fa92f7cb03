// An interval of float32.
#pragma once

#include <limits>

namespace etlc::check {

/// Closed interval of float32 values, rounded outward from the decimal text.
struct Range {
    float low = -std::numeric_limits<float>::infinity();
    float high = std::numeric_limits<float>::infinity();

    bool contains(float x) const { return low <= x && x <= high; }
};

}  // namespace etlc::check
