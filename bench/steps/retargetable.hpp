// The same classes with their numbers in parameters, made from the same specs with --retargetable,
// in a separate namespace.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace bench {

struct Retargetable {
    std::function<void()> step;      ///< once over all samples
    std::function<void()> retarget;  ///< checks and takes a block of parameters
    std::size_t state_bytes = 0;
    std::size_t params_bytes = 0;
};

/// By the name of the example.
Retargetable retargetable(const std::string& example);

}  // namespace bench
