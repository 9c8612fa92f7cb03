// Evaluates specs on episodes given as text.
// Takes: a spec and .csv episodes. Gives: the evaluation. Keeps true: it runs the same functions as
// `etlc evaluate`; the files are in the test's own folder, removed afterwards.
#pragma once

#include <string>
#include <vector>

#include "evaluate/evaluate.hpp"

namespace etlc::tests {

/// Returns the model of a valid spec.
check::Model model_of(const std::string& spec);

/// Evaluates with this many threads; returns the messages on failure.
evaluate::Judgement judged(const std::string& spec, const std::vector<std::string>& episodes,
                           unsigned jobs = 1, const std::vector<episodes::Variant>& variants = {});
evaluate::Evaluation evaluated(const std::string& spec, const std::vector<std::string>& episodes,
                               unsigned jobs = 1,
                               const std::vector<episodes::Variant>& variants = {});
std::vector<std::string> mistakes(const std::string& spec,
                                  const std::vector<std::string>& episodes);

}  // namespace etlc::tests
