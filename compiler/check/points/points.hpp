// Points of distances, and target sets in their spaces. Equal points are shared, and a point
// follows the one that it is projected from. The declaration of a target determines the space of
// its rows, never their dimension.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"
#include "check/model/model.hpp"

namespace etlc::check {

/// Returns the index in model.points; kNone after an error.
Index check_point(Context& context, const ast::Point& point);

/// Returns the steps of `@TIME`, at least 1; nothing after an error.
std::optional<std::uint32_t> steps_ago(Context& context, const ast::Bound& time);

/// Returns the point with all its delays shortened alike until the shortest is zero.
Index without_delay(Context& context, Index point);

/// Returns the space that a point is in, as a point without delay or sums.
Index space_of(Context& context, Index point);

/// Whether two points have equal dimensions and went through equal projections, or through
/// projections that are declared to be in one space. A sum is in the space of its parts.
bool is_same_space(const Model& model, Index a, Index b);

/// Reports points that are not of one space or by different encoders; false after an error.
bool check_same_space(Context& context, Index a, Index b, Span span);

/// Reports embeddings by two encoders, which have nothing to do with each other; false after an
/// error. Inputs that begin at the same element are compared: [x, y] may stand for one of two.
bool encoders_fit(Context& context, Index point, Index other, Span span);

/// Whether an input may be by the encoder that `other` is by; false after an error.
bool is_by(Context& context, const Input& one, Index encoder, const std::string& other, Span span);

/// Returns the target if its rows are in the space of the point, otherwise a target with the
/// projected rows; kNone, with an error, if no projection of the point leads there or the
/// dimensions differ.
Index target_in_space(Context& context, Index target, Index point, Span span);

// fitted(METHOD, of = POINT, where = FORMULA, ...): elements that `etlc fit` computes from
// episodes, and their values in its file. An element depends only on projections declared before
// it.

/// Returns the index in model.fitted; kNone after an error. It fills the declaration `name`, the
/// model's target or projection `index`. Metrics, mahalanobis(fitted(...)), have neither, and equal
/// ones are shared.
Index check_fitted(Context& context, const ast::Fitted& written, Fitted::Slot slot,
                   std::string name = {}, Index index = kNone);

/// Returns the entry with the shape that the spec asks for, and marks the element as filled; null
/// if there is none, which is an error unless --check allows it. The first call reads the file.
const fitted::Entry* fitted_entry(Context& context, Index fitted);

// Projects points and rows of targets, and inserts fitted values. Rows go through all maps in
// double and are rounded once, to float32.

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
