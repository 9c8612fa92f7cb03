// The same classes with their numbers in parameters, which are other classes: made from the same
// specs with --retargetable, in a namespace of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace bench {

struct Retargetable {
    std::function<void()> step;      ///< once over all samples
    std::function<void()> retarget;  ///< checks a block of parameters and takes it
    std::size_t state_bytes = 0;
    std::size_t params_bytes = 0;
};

/// By the name of the example.
Retargetable retargetable(const std::string& example);

}  // namespace bench
