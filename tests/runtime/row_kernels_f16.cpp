// Compiles the kernels for rows of float16.
#include "row_kernels.hpp"

namespace kernel_cases {
template std::vector<RowVersion<const std::uint16_t*>> row_versions(etlmon::MetricId);
}  // namespace kernel_cases
