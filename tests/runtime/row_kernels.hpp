// Defines row_versions, declared in kernel_versions.hpp, for the three sources that compile the
// kernels: one a storage, as all kernels together take too long.
#pragma once

#include <type_traits>

#include "guarded.hpp"
#include "kernel_versions.hpp"

namespace kernel_cases {

/// What a kernel reads of a case, each piece before memory that nothing may touch.
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

template <class Metric, class Aggregation, class G>
std::vector<RowVersion<G>> row_versions_of() {
    std::vector<RowVersion<G>> found;
    for (const auto& version : versions<Metric, Aggregation, etlmon::detail::Sizes, false, G>()) {
        const auto measure = [run = version.run](const exact::Case& c, G rows,
                                                 exact::Aggregate aggregate) {
            std::vector<float> smallest(aggregate.n);
            Aggregation aggregation{};
            if constexpr (std::is_same_v<Aggregation, etlmon::KthOf>)
                aggregation = {smallest.data(), aggregate.n, 0};
            static GuardedCase guarded;
            const std::size_t elements = std::size_t{c.rows} * c.dimension;
            return etlmon::detail::unpacked(run(guarded.z(c), guarded.rows(rows, elements),
                                                guarded.weights(c), {c.rows, c.dimension},
                                                aggregation));
        };
        found.push_back({version.name, version.fused, measure});
    }
    return found;
}

template <class Metric, class G>
std::vector<RowVersion<G>> row_versions_of(etlmon::AggregationId aggregation) {
    using Id = etlmon::AggregationId;
    switch (aggregation) {
        case Id::min: return row_versions_of<Metric, etlmon::Min, G>();
        case Id::max: return row_versions_of<Metric, etlmon::Max, G>();
        case Id::mean: return row_versions_of<Metric, etlmon::Mean, G>();
        case Id::kth: break;
    }
    return row_versions_of<Metric, etlmon::KthOf, G>();
}

template <class G>
std::vector<RowVersion<G>> row_versions(etlmon::MetricId metric,
                                        etlmon::AggregationId aggregation) {
    switch (metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case etlmon::MetricId::id:                        \
        return row_versions_of<etlmon::Type, G>(aggregation);
#include "etlmon/distances.def"
#undef DISTANCE
    }
    return {};
}

}  // namespace kernel_cases
