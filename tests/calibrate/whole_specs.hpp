// Specs whose scores depend on everything that a spec may say, and episodes for them.
// Takes: how a threshold is calibrated. Gives: texts. Keeps true: each spec has one thing that is
// calibrated, the threshold of `a` or the shift of `m`, which reads all that is declared.
#pragma once

#include <string>
#include <vector>

#include "random.hpp"

namespace etlc::tests {

/// `truth a = ...;`, and a predicate that is its own truth, as they stand in the specs.
extern const std::string kTruth;
extern const std::string kOwn;

/// Predicates by this threshold, and monitors as wholes against one kind of error.
std::string of_predicate(const std::string& threshold);
std::string of_monitor(const std::string& against);
/// By every method.
const std::vector<std::string>& predicate_specs();
/// These, and monitors.
const std::vector<std::string>& specs();

/// The first `from` in it becomes `to`; a failure of the test where there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Texts of .csv files; `label`: with an array truth.a, which knows nothing of the rest.
std::vector<std::string> random_episodes(Random& random, int count, bool label = false);

}  // namespace etlc::tests
