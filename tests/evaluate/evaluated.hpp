// Specs evaluated on episodes given as text.
// Takes: a spec and .csv episodes. Gives: the evaluation. Keeps true: it goes through the same
// functions as `etlc evaluate`; the files lie in a folder of the test's own, gone afterwards.
#pragma once

#include <string>
#include <vector>

#include "evaluate/evaluate.hpp"

namespace etlc::tests {

/// The model of a spec without mistakes.
check::Model model_of(const std::string& spec);

/// Of these episodes, with so many threads. The messages where it fails.
evaluate::Judgement judged(const std::string& spec, const std::vector<std::string>& episodes,
                           unsigned jobs = 1);
evaluate::Evaluation evaluated(const std::string& spec, const std::vector<std::string>& episodes,
                               unsigned jobs = 1);
std::vector<std::string> mistakes(const std::string& spec,
                                  const std::vector<std::string>& episodes);

}  // namespace etlc::tests
