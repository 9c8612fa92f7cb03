// Rows of targets, projected as the points are that they are compared with, and putting in place
// what was fitted.
// Takes: a model. Gives: the same with the numbers. Keeps true: rows go through all maps in double
// and are rounded once, to float32; what is not fitted yet has its shape and no values.
#pragma once

#include <optional>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::check {

/// A (z - m), in double. z has projection.dimension elements.
std::vector<double> projected(const Projection& projection, const std::vector<double>& z);

/// The whole point from the elements of its inputs.
std::vector<double> projected(const Model& model, Index point, std::vector<double> z);

/// Sets the rows of a target that has a `source`, where those and the maps are there; else it has
/// none. Gives the first row that is not finite in float32, if there is one.
std::optional<std::uint32_t> project_target(Model& model, Index target);

/// What was fitted: R x D numbers, row-major, as model.fitted says, and of a projection its offset,
/// D or none.
struct Filling {
    std::vector<float> matrix;
    std::vector<float> offset;
};

/// Puts what was fitted in its place, and projects again the targets that depend on it. Gives the
/// first target with a row that is not finite then.
std::optional<Index> fill(Model& model, Index fitted, const Filling& filling);

/// The distance depends on something that is fitted.
bool rests_on_fitted(const Model& model, const Distance& distance);

/// Content hash of a projection's matrix, with the offset as one row more where there is one.
std::string projection_hash(const Projection& projection);

}  // namespace etlc::check
