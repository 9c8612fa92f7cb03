// Compiles the kernels for rows of float32, and the one that a program calls.
#include "row_kernels.hpp"

namespace kernel_cases {

template std::vector<RowVersion<const float*>> row_versions(etlmon::MetricId);

etlmon::Measured run(const exact::Case& c, exact::Aggregate aggregate) {
    std::vector<float> prepared = c.targets;
    std::vector<float> scratch(aggregate.n);
    etlmon::prepare(c.metric, prepared.data(), c.rows, c.dimension);
    return etlmon::measure(c.metric, aggregate.id, aggregate.n, c.z.data(), prepared.data(), c.rows,
                           c.dimension, c.weights.data(), scratch.data());
}

}  // namespace kernel_cases
