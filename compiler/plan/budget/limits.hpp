// What a plan may cost, and who is asked what would fit in place of a monitor that does not.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::plan {

struct Limits {
    std::uint64_t state_bytes = 1U << 20U;  ///< and the stack of a step with it
    std::uint64_t code_bytes = 64U << 10U;
    std::uint64_t operations = 1U << 20U;
    /// Larger target sets go to a file beside the header.
    std::uint64_t inline_target_bytes = 256U << 10U;
};

/// What would fit in place of a monitor that does not, all monitors together or it alone.
enum class Among : std::uint8_t { all, alone };
using Advice = std::function<std::vector<diag::Note>(check::Index monitor, Among among)>;

}  // namespace etlc::plan
