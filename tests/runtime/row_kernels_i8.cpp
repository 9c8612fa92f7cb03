// Compiles the kernels for rows of int8.
#include "row_kernels.hpp"

namespace kernel_cases {
template std::vector<RowVersion<etlmon::detail::ScaledRows>> row_versions(etlmon::MetricId);
}  // namespace kernel_cases
