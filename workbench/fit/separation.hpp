// How well predicates tell frames apart on episodes that nothing was fitted on.
// Takes: what was collected. Gives: per predicate the area under the ROC curve of its distance, of
// the plain distance, and the frames that rank worst. Keeps true: each episode is measured with
// what was fitted on the folds without it, by the kernels of the monitor; scores are compared
// within a fold alone.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "episodes/data_warnings.hpp"
#include "episodes/ranking/auroc.hpp"
#include "fit/collect.hpp"
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

struct WorstFrame {
    std::size_t episode = 0;
    std::size_t step = 0;
    bool positive = false;
    double ordered =
        0;  ///< part of the frames of the other class that it ranks on the right side of
};

struct Separation {
    Index predicate = 0;  ///< that is measured
    /// Of l2 to the mean of the frames at which it holds, in the space of the input; nothing where
    /// it measures from several inputs, or where there are no such frames.
    std::optional<episodes::Auroc> before;
    std::optional<episodes::Auroc> after;
    std::vector<WorstFrame> worst;  ///< worst first, one of an episode
    episodes::Labels labels;        ///< of the frames that are measured after the fit
};

/// The predicates to ask about: their distance rests on something fitted, and they have labels.
std::vector<Index> separating_predicates(const check::Model& model,
                                         const std::vector<Index>& labelled);

/// The mean that the plain distance is measured from; nothing where there is none.
std::optional<Need> plain_need(const check::Model& model, Index predicate);

/// The first fitted thing that its distances rest on and that is refused.
std::optional<Index> refused_for(const Filled& filled, Index predicate);

/// `why_not`: set where some fold cannot be fitted. Nothing where the sink now says why.
struct Separations {
    std::vector<Separation> all;
    std::string why_not;
};
/// `folds`: filled without each fold.
std::optional<Separations> separate(const std::vector<Filled>& folds, const Solver& solver,
                                    const std::vector<Measured>& predicates, const Request& request,
                                    diag::Sink& sink);

}  // namespace etlc::fit
