// What measure() is made of: samples, and the kernels' calls on them.
// Takes: the context. Gives: expressions that stand for this step's samples and distances, and the
// statements that they need. Keeps true: what is missing has no distance: NaN, and row 0.
#pragma once

#include <optional>
#include <string>

#include "emit/context.hpp"

namespace etlc::emit {

/// This step's sample: a scalar, NaN where it is missing; of an embedding a pointer, null where it
/// is missing, or the view itself, where the kernels look whether it is there.
std::string sample(const Context& context, check::Index input);

/// The statement that takes note of a sample that is missing, or of something that is not known.
std::string missed(const std::string& condition);

/// What has to be said before sample() of this input can be.
void print_input(Printer& out, const Context& context, check::Index input);

/// The call that measures a distance where there is one for whatever the sample is; else
/// print_distance has more to say.
std::optional<std::string> measured_at_once(const Context& context, check::Index distance);

/// A projected point, by the name of names.point_local: where its elements lie, null where it is
/// unknown.
void print_projected(Printer& out, const Context& context, check::Index point);
/// `into = ...` where the inputs are there, on float32 rows: an Enclosed that is exact.
void print_exact_distance(Printer& out, const Context& context, check::Index distance,
                          const std::string& into);

/// "{threshold_near(), 0.5f}": where comparisons turn. The threshold of a predicate that compares
/// the distance, or of this one, by name.
std::string cuts(const Context& context, const plan::NarrowSet& set);
std::string cuts(const std::vector<plan::Cut>& cuts, const check::Predicate& of);

/// `into = ...` where the inputs are there: a Measured that was unmeasured, or an Enclosed.
void print_distance(Printer& out, const Context& context, check::Index distance,
                    const std::string& into);

}  // namespace etlc::emit
