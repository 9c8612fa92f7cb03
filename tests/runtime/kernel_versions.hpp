// The versions of the kernel that were compiled and that the CPU has.
// Takes: a distance, an aggregation, how rows are stored. Gives: a function of each. Keeps true: `baseline` comes
// first.
#pragma once

#include <vector>

#include "etlmon/kernel.hpp"
#include "kernel_cases.hpp"

namespace kernel_cases {

template <class Metric, class Aggregation, class Size, bool InColumns, class G = const float*>
using Run = etlmon::Measured (*)(const float*, G, const float*, Size, Aggregation) noexcept;

template <class Metric, class Aggregation, class Size, bool InColumns, class G = const float*>
struct Version {
    const char* name;
    bool fused;
    Run<Metric, Aggregation, Size, InColumns, G> run;
};

/// Which versions: all, or one alone where compiling all would take too long.
enum class Which { all, baseline, v3, v4 };

/// The versions that were compiled and that the CPU has.
template <class Metric, class Aggregation, class Size, bool InColumns, class G = const float*, Which W = Which::all>
std::vector<Version<Metric, Aggregation, Size, InColumns, G>> versions() {
    std::vector<Version<Metric, Aggregation, Size, InColumns, G>> found;
    if constexpr (W == Which::all || W == Which::baseline)
        found.push_back({"baseline", false, etlmon::detail::baseline::run<Metric, Aggregation, Size, InColumns, G>});
#if defined(ETLMON_DISPATCH)
    [[maybe_unused]] const std::uint32_t level = etlmon::detail::x86_64_level();
#if ETLMON_X86_64 < 3
    if constexpr (W == Which::all || W == Which::v3) {
        if (level >= 3)
            found.push_back({"v3", true, etlmon::detail::x86_64_v3::run<Metric, Aggregation, Size, InColumns, G>});
    }
#endif
    if constexpr (W == Which::all || W == Which::v4) {
        if (level >= 4)
            found.push_back({"v4", true, etlmon::detail::x86_64_v4::run<Metric, Aggregation, Size, InColumns, G>});
    }
#endif
    return found;
}

}  // namespace kernel_cases
