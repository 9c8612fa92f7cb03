// The options of `etlc evaluate` and `etlc crossvalidate`.
// Gives: a request. Keeps true: a call that contradicts itself is refused with what is wrong about
// it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "driver/evaluate/evaluate.hpp"

namespace etlc::driver {

void add_evaluate_options(CLI::App& app, EvaluateRequest& evaluation, bool crossvalidates);

/// The call's own mistakes that CLI11 cannot see; empty where there are none.
std::string mistake_in_evaluate_call(const CLI::App& app, const std::vector<std::string>& specs,
                                     const EvaluateRequest& evaluation);

}  // namespace etlc::driver
