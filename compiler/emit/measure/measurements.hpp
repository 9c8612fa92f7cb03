// The parts of measure(): code for the samples and distances of a step, and the statements before
// them. The distance of a missing sample is NaN, with row 0.
#pragma once

#include <optional>
#include <string>

#include "emit/context.hpp"

namespace etlc::emit {

/// Returns code for this step's sample: a scalar, NaN if missing; a pointer to an embedding, null
/// if missing; or the view itself, if the kernels check it.
std::string sample(const Context& context, check::Index input);

/// Returns the statement that marks the step as incomplete under a condition.
std::string missed(const std::string& condition);

/// Prints the declarations that sample() of this input needs.
void print_input(Printer& out, const Context& context, check::Index input);

/// Returns the call that measures a distance and also handles missing samples; nothing if it takes
/// the statements of print_distance.
std::optional<std::string> measured_at_once(const Context& context, check::Index distance);

/// Returns the pointer to the elements of a point, null if it is missing; not for vectors of
/// scalars that are measured in place.
std::string elements_of(const Context& context, check::Index point);
/// Returns the elements of a vector of scalars: "px, py".
std::string scalars_of(const Context& context, const check::Point& point);
/// Declares names.point_local, the pointer to a point that is no sample of the step; null if it is
/// unknown.
void print_point(Printer& out, const Context& context, check::Index point);
/// Prints `into = ...` on float32 rows if the inputs are present: an exact Enclosed.
void print_exact_distance(Printer& out, const Context& context, check::Index distance,
                          const std::string& into);

/// Returns the numbers at which comparisons change, "{threshold_near(), 0.5f}". Thresholds of named
/// predicates are called by name.
std::string cuts(const Context& context, const plan::NarrowSet& set);
std::string cuts(const std::vector<plan::Cut>& cuts, const check::Predicate& of);

/// Prints `into = ...` if the inputs are present: a Measured, so far unmeasured, or an Enclosed.
void print_distance(Printer& out, const Context& context, check::Index distance,
                    const std::string& into);

}  // namespace etlc::emit
