// Stores target sets in float16 or int8: `--targets-as`. Computes per distance the narrow rows, how
// far narrowing moved a row, and the numbers at which a comparison changes. `moved` is an upper
// bound of the true distance between a float32 row and its narrow copy, in the norm of
// etlmon/distance/enclosed.hpp; where no row moved, no other copy is kept.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "diag/diag.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Returns the nearest float16, ties to even, as a double; infinite beyond 65504.
double to_f16(double x);

/// Fills plan.narrow with every distance that can be measured on narrow rows: those that predicates
/// compare with a number, or whose difference they compare (a contrast). Other expressions,
/// adaptive thresholds and mahalanobis with full weights keep float32. Reports what makes it
/// impossible.
void narrow_targets(Plan& plan, Storage storage, diag::Sink& sink);

/// Returns both distances of a named predicate that compares their difference with a constant;
/// nothing for others.
std::optional<std::pair<Index, Index>> contrast(const check::Predicate& predicate);

/// Returns the numbers at which a contrast changes, where narrow rows leave it open; else nothing.
std::vector<Cut> contrast_cuts(const Plan& plan, const check::Predicate& predicate);

/// Returns the narrow rows of a distance; null where it is measured on float32.
const NarrowSet* narrow_set(const Plan& plan, Index distance);

/// Returns its rows as the kernels widen them: float32, with one rounding per element of int8.
std::vector<float> widened_rows(const NarrowSet& set);

/// Returns the bytes of its rows.
std::uint64_t bytes_of(const NarrowSet& set);

/// Returns "f16", "i8" or "f32".
const char* word(Storage storage);

}  // namespace etlc::plan
