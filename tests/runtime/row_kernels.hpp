// Defines row_versions, declared in kernel_versions.hpp, for the three sources that compile the
// kernels: one per storage, because all together compile too slowly.
#pragma once

#include "etlmon/hosted/dynamic.hpp"
#include "guarded.hpp"
#include "kernel_versions.hpp"

namespace kernel_cases {

/// The data that a kernel reads, each piece before an inaccessible page.
class GuardedCase {
public:
    const float* z(const exact::Case& c) { return z_.copy(c.z.data(), c.z.size()); }
    const float* weights(const exact::Case& c) {
        return weights_.copy(c.weights.data(), c.weights.size());
    }
    template <class T>
    const T* rows(const T* from, std::size_t elements) {
        return rows_.copy(from, elements);
    }
    etlmon::detail::ScaledRows rows(etlmon::detail::ScaledRows from, std::size_t elements) {
        return {rows_.copy(from.values, elements), from.scale};
    }

private:
    Guarded z_, weights_, rows_;
};

/// Returns the compiled versions that the CPU supports. Each compiles only the values of rows.
template <class Metric, class G>
std::vector<RowVersion<G>> row_versions_of() {
    using namespace etlmon::detail;
    std::vector<RowVersion<G>> found;
    const auto add = [&](const char* name, bool fused, auto row_values) {
        found.push_back({name, fused, [=](const exact::Case& c, G rows, exact::Aggregate a) {
                             std::vector<float> smallest(a.n);
                             static GuardedCase guarded;
                             const std::size_t elements = std::size_t{c.rows} * c.dimension;
                             return aggregate_rows<Metric>(
                                 row_values, a.id, a.n, guarded.z(c), guarded.rows(rows, elements),
                                 c.rows, c.dimension, guarded.weights(c), smallest.data());
                         }});
    };
    add("baseline", false, baseline::row_values<Metric, G>);
#if defined(ETLMON_DISPATCH)
    const std::uint32_t level = x86_64_level();
#if ETLMON_X86_64 < 3
    if (level >= 3) add("v3", true, x86_64_v3::row_values<Metric, G>);
#endif
    if (level >= 4) add("v4", true, x86_64_v4::row_values<Metric, G>);
#endif
    return found;
}

template <class G>
std::vector<RowVersion<G>> row_versions(etlmon::MetricId metric) {
    switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case etlmon::MetricId::id:                        \
        return row_versions_of<etlmon::Type, G>();
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
    return {};
}

}  // namespace kernel_cases
