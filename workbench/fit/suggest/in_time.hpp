// Formulas over time in place of a predicate, for `etlc fit --suggest`: how long it has to hold
// before it counts, for how long it counts afterwards, and what it follows. All candidates are
// lets with the predicate's truth in one text of the spec, which is then judged like any other, so
// the suggested lines give the figures beside them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/bootstrap.hpp"

namespace etlc::fit {

/// A formula in place of a predicate, or in place of predicates in a monitor.
struct InTime {
    std::string formula;             ///< "held[15 steps] hold"; for a monitor what replaces what
    std::vector<std::string> lines;  ///< lines to paste; empty: as it is
    std::string trial;               ///< name of the let, predicate or monitor that is judged
    /// F1 by frames; for a monitor the mean of the agreements on episodes and on broken variants.
    episodes::Figure score{};
    std::optional<double> on_episodes{};
    std::optional<double> on_variants{};
    bool ties = false;  ///< the interval of its difference to the best has 0
};

struct RankedInTime {
    std::string name;  ///< of the predicate or monitor
    bool of_monitor = false;
    std::vector<InTime> ranked;     ///< best first
    std::optional<double> clock{};  ///< F1 of the number of the step alone; predicates only
};

struct SuggestedInTime {
    std::vector<RankedInTime> all;
    std::size_t folds = 0;  ///< 0: nothing was trained
    std::string why_not;    ///< why nothing was tried; empty: it was
};

/// The text of a spec with all candidates, without its monitors.
struct TimeTrials {
    std::string text;
    std::vector<RankedInTime> all;  ///< in the order of the spec, without figures
};

/// `asked`: predicates to replace; `labelled`: those with a truth, which a formula may follow.
/// Monitors over lets that have a truth, or too long to be printed, are left as they are.
TimeTrials time_trials(const check::Model& model, const std::vector<check::Index>& asked,
                       const std::vector<check::Index>& labelled);

/// Sorts the candidates by their scores, the best first.
void rank(RankedInTime& all);

std::string report(const SuggestedInTime& suggested);
std::string json(const SuggestedInTime& suggested);

}  // namespace etlc::fit
