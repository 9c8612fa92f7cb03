// Specs whose scores depend on everything that a spec may contain, and episodes for them.
// Takes: the method of calibration. Gives: texts. Keeps true: each spec calibrates one thing, the
// threshold of `a` or the shift of `m`, which reads everything declared.
#pragma once

#include <string>
#include <vector>

#include "random.hpp"

namespace etlc::tests {

/// `truth a = ...;`, and a predicate that is its own truth, as written in the specs.
extern const std::string kTruth;
extern const std::string kOwn;

/// Returns a spec with predicates by this threshold, or with monitors as a whole against one error.
std::string of_predicate(const std::string& threshold);
std::string of_monitor(const std::string& against);
/// Returns specs for every method.
const std::vector<std::string>& predicate_specs();
/// The same and those for monitors.
const std::vector<std::string>& specs();

/// Replaces the first `from`; fails the test if there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Returns texts of .csv files; `label`: with an array truth.a, independent of the rest.
std::vector<std::string> random_episodes(Random& random, int count, bool label = false);

}  // namespace etlc::tests
