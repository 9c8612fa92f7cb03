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

/// The versions that were compiled and that the CPU has.
template <class Metric, class Aggregation, class Size, bool InColumns, class G = const float*>
std::vector<Version<Metric, Aggregation, Size, InColumns, G>> versions() {
    std::vector<Version<Metric, Aggregation, Size, InColumns, G>> all{
        {"baseline", false, etlmon::detail::baseline::run<Metric, Aggregation, Size, InColumns, G>}};
#if defined(ETLMON_DISPATCH)
    const std::uint32_t level = etlmon::detail::x86_64_level();
#if ETLMON_X86_64 < 3
    if (level >= 3)
        all.push_back({"v3", true, etlmon::detail::x86_64_v3::run<Metric, Aggregation, Size, InColumns, G>});
#endif
    if (level >= 4)
        all.push_back({"v4", true, etlmon::detail::x86_64_v4::run<Metric, Aggregation, Size, InColumns, G>});
#endif
    return all;
}

}  // namespace kernel_cases
