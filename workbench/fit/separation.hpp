// Measures how well predicates separate frames of episodes that were not fitted on: the AUROC of
// their distance and of the plain distance, and the frames that rank worst. Each episode is
// measured with what was fitted on the other folds, by the kernels of the monitor; scores are
// compared within a fold only.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "episodes/admission/admission.hpp"
#include "episodes/ranking/auroc.hpp"
#include "fit/collect.hpp"
#include "fit/solve.hpp"

namespace etlc::fit {

/// A model with everything fitted, in order. A thing that cannot be fitted, or depends on such a
/// thing, is refused and has no values.
struct Filled {
    check::Model model;
    std::vector<Solution> solutions;    ///< per fitted thing
    std::map<Index, Refusal> refusals;  ///< by fitted thing
};
Filled fill(const check::Model& model, Solver& solver, std::optional<std::size_t> left_out);

/// Fits in threads: on all folds if `all`, and without each fold if `without`.
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
    double ordered = 0;  ///< share of the frames of the other class that it ranks correctly against
};

struct Separation {
    Index predicate = 0;  ///< the predicate that is measured
    /// The AUROC of l2 to the mean of the positive frames, in the space of the input; undefined for
    /// several inputs, or without such frames.
    episodes::Figure before;
    episodes::Figure after;
    std::vector<WorstFrame> worst;  ///< worst first, one per episode
    episodes::Labels labels;        ///< of the frames measured after the fit
};

/// Returns the labelled predicates whose distance depends on something fitted.
std::vector<Index> separating_predicates(const check::Model& model,
                                         const std::vector<Index>& labelled);

/// Returns the mean from which the plain distance is measured; nothing where there is none.
std::optional<Need> plain_need(const check::Model& model, Index predicate);

/// Returns the first refused fit that the predicate depends on.
std::optional<Index> refused_for(const Filled& filled, Index predicate);

/// `why_not`: why some fold cannot be fitted; else empty.
struct Separations {
    std::vector<Separation> all;
    std::string why_not;
};
/// `folds`: fitted without each fold. Returns nothing after an error.
std::optional<Separations> separate(const std::vector<Filled>& folds, const Solver& solver,
                                    const std::vector<Measured>& predicates, const Request& request,
                                    diag::Sink& sink);

}  // namespace etlc::fit
