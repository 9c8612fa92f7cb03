// Projects points and rows of targets, and inserts fitted values. Rows go through all maps in
// double and are rounded once, to float32.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// Returns A (z - m) in double; z has projection.dimension elements.
std::vector<double> projected(const Projection& projection, const std::vector<double>& z);

/// Returns the point computed from the elements of its inputs.
std::vector<double> projected(const Model& model, Index point, std::vector<double> z);

/// Sets the rows of a target that has a `source`; it has none until those and the maps are fitted.
/// Returns the first row that is not finite in float32.
std::optional<std::uint32_t> project_target(Model& model, Index target);

/// Fitted values: R x D numbers, row-major, and the offset of a projection, D numbers or none.
struct Filling {
    std::vector<float> matrix;
    std::vector<float> offset;
};

/// Inserts fitted values and projects the targets that depend on them again. Returns the first
/// target with a row that is not finite.
std::optional<Index> fill(Model& model, Index fitted, const Filling& filling);

/// Whether the distance depends on something fitted.
bool rests_on_fitted(const Model& model, const Distance& distance);

/// Returns the steps between a point and the earliest sample that it needs.
std::uint32_t longest_delay(const Model& model, Index point);

/// Returns the point of the model that a delayed one is the earlier value of, also inside of
/// projections; kNone for points put together.
Index as_of_now(const Model& model, Index point);

/// Whether a point consists of samples alone, now and of earlier steps, without projections.
bool is_recorded(const Model& model, Index point);

/// Returns the content hash of a projection's matrix, with the offset as one more row.
std::string projection_hash(const Projection& projection);

}  // namespace etlc::check
