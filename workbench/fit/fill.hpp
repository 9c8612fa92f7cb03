// A model with all that it has fitted.
// Takes: a model, and a solver. Gives: the same with values, or why something has none; without
// each fold as well, where that is asked for. Keeps true: the number of threads does not count.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "fit/solve.hpp"

namespace etlc::fit {

/// All that a model has fitted, in order. What cannot be fitted, or rests on such a thing, is
/// refused, and stays without values.
struct Filled {
    check::Model model;
    std::vector<Solution> solutions;    ///< per fitted thing
    std::map<Index, Refusal> refusals;  ///< by fitted thing
};
Filled fill(const check::Model& model, Solver& solver, std::optional<std::size_t> left_out);

/// In threads: with all folds, where that is wanted, and without each, where that is.
struct FilledAll {
    std::optional<Filled> all;
    std::vector<Filled> without;  ///< per fold
};
FilledAll fill_all(const check::Model& model, Solver& solver, bool all, bool without,
                   unsigned jobs);

}  // namespace etlc::fit
