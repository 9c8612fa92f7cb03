// The compiled versions of the kernel that the CPU supports.
// Takes: a distance, an aggregation, the storage of rows. Gives: a function per version. Keeps
// true: `baseline` comes first; a kernel with a run-time number of rows is compiled once per
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

/// The versions of a kernel that is compiled on demand.
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

/// One version for a run-time number of rows, any distance and any aggregation.
template <class G>
struct RowVersion {
    const char* name;
    bool fused;
    /// Measures the z of a case with its weights and these rows.
    std::function<etlmon::Measured(const exact::Case&, G, exact::Aggregate)> measure;
};

/// G: const float*, const std::uint16_t* or etlmon::detail::ScaledRows.
template <class G>
std::vector<RowVersion<G>> row_versions(etlmon::MetricId metric);

}  // namespace kernel_cases
