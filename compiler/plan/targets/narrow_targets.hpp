// Target sets in float16 or int8: `--targets-as`.
// Takes: a plan, and the storage asked for. Gives: per distance the narrow rows, how far the
// narrowing moved a row, and the numbers at which a comparison turns. Keeps true: `moved` is never
// below the true distance between a float32 row and its narrow copy, in the norm that
// etlmon/distance/enclosed.hpp reckons with; where no row moved, nothing else is kept.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "diag/diag.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// The nearest float16, ties to even, as a double; infinite beyond 65504.
double to_f16(double x);

/// Fills plan.narrow with every distance that can be measured on narrow rows: those that predicates
/// compare with a number as they are, or whose difference they compare (a contrast). Other
/// expressions, adaptive thresholds and mahalanobis with full weights keep float32. Reports what
/// makes it impossible.
void narrow_targets(Plan& plan, Storage storage, diag::Sink& sink);

/// Both distances of a predicate that has a name and compares their difference with a number that
/// stays; nothing for others.
std::optional<std::pair<Index, Index>> contrast(const check::Predicate& predicate);

/// Of a contrast of which narrow rows leave something open: the numbers at which it turns; else
/// nothing.
std::vector<Cut> contrast_cuts(const Plan& plan, const check::Predicate& predicate);

/// The narrow rows of a distance; null where it is measured on float32.
const NarrowSet* narrow_set(const Plan& plan, Index distance);

/// Its rows as the kernels widen them: float32, one rounding an element of int8.
std::vector<float> widened_rows(const NarrowSet& set);

/// Bytes of its rows.
std::uint64_t bytes_of(const NarrowSet& set);

/// "f16", "i8", "f32"
const char* word(Storage storage);

}  // namespace etlc::plan
