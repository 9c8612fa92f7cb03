#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bench {

/// Returns the middle value; for an even number the upper one, for none 0.
inline double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace bench
