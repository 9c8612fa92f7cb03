// The versions of the kernel that were compiled and that the CPU has.
// Takes: a distance, an aggregation, how rows are stored. Gives: a function of each. Keeps true:
// `baseline` comes first; a kernel on rows whose number is known at run time is compiled once per
// program, in row_kernels_*.cpp.
#pragma once

#include <functional>
#include <vector>

#include "etlmon/distance/kernel.hpp"
#include "kernel_cases.hpp"

namespace kernel_cases {

template <class Metric, class Aggregation, class Size, bool InColumns, class G = const float*>
struct Version {
    const char* name;
    bool fused;
    etlmon::detail::MeasuredBits (*run)(const float*, G, const float*, Size, Aggregation) noexcept;
};

/// The versions of a kernel that is compiled for the asking.
template <class Metric, class Aggregation, class Size, bool InColumns, class G = const float*>
std::vector<Version<Metric, Aggregation, Size, InColumns, G>> versions() {
    using namespace etlmon::detail;
    std::vector<Version<Metric, Aggregation, Size, InColumns, G>> found{
        {"baseline", false, baseline::run<Metric, Aggregation, Size, InColumns, G>}};
#if defined(ETLMON_DISPATCH)
    const std::uint32_t level = x86_64_level();
#if ETLMON_X86_64 < 3
    if (level >= 3)
        found.push_back({"v3", true, x86_64_v3::run<Metric, Aggregation, Size, InColumns, G>});
#endif
    if (level >= 4)
        found.push_back({"v4", true, x86_64_v4::run<Metric, Aggregation, Size, InColumns, G>});
#endif
    return found;
}

/// One version on rows whose number is known at run time, whatever the distance and the
/// aggregation.
template <class G>
struct RowVersion {
    const char* name;
    bool fused;
    /// What it makes of the z and the weights of a case, and of these rows.
    std::function<etlmon::Measured(const exact::Case&, G, exact::Aggregate)> measure;
};

/// G: const float*, const std::uint16_t* or etlmon::detail::ScaledRows.
template <class G>
std::vector<RowVersion<G>> row_versions(etlmon::MetricId metric);

}  // namespace kernel_cases
