// The same classes with a flight recorder, made from the same specs with --recorder, in a separate
// namespace.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace bench {

struct Recorded {
    std::function<void()> step;  ///< once over all samples
    std::size_t state_bytes = 0;
};

/// By the name of the example.
Recorded recorded(const std::string& example);

}  // namespace bench
