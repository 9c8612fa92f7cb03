// What the runtime's kernels are called with.
// Takes: a distance of the model. Gives: the rows of its target set in the form that the kernel
// wants, and its name there. Keeps true: computed in double and in fixed order, so every machine
// makes the same constants.
#pragma once

#include <string>
#include <vector>

#include "check/model.hpp"
#include "etlmon/dynamic.hpp"

namespace etlc::plan {

/// The row of etlmon/distances.def.
etlmon::MetricId metric_id(const check::Distance& distance);

/// K x D float32, row-major: of length 1 for cosine and angular, else as given.
std::vector<float> prepared_rows(const check::Model& model, const check::Distance& distance);
bool rows_as_given(const check::Distance& distance);

/// The struct of etlmon/distances.hpp: "L2".
std::string metric_name(const check::Distance& distance);

}  // namespace etlc::plan
