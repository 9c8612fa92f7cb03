// Suggests distances that separate a predicate, and their costs: `etlc fit --suggest`. Candidates
// are ranked by how well they separate on episodes that were not fitted on. The suggested lines are
// measured as `etlc fit` would measure them, so they give the figures beside them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/bootstrap.hpp"
#include "episodes/ranking/auroc.hpp"
#include "fit/collect.hpp"

namespace etlc::fit {

// Formulas over time in place of a predicate, for `etlc fit --suggest`: how long it has to hold
// before it counts, for how long it counts afterwards, and what it follows. All candidates are
// lets with the predicate's truth in one text of the spec, which is then judged like any other, so
// the suggested lines give the figures beside them.

/// A formula in place of a predicate, or in place of predicates in a monitor; or a deadline.
struct InTime {
    std::string formula;             ///< "held[15 steps] hold"; for a monitor what replaces what
    std::vector<std::string> lines;  ///< lines to paste; empty: as it is
    std::string trial;               ///< name of the let, predicate or monitor that is judged
    episodes::Figure score{};        ///< see RankedBy
    std::vector<std::optional<double>> parts{};  ///< of the score, as titles_of names them
    bool ties = false;  ///< the interval of its difference to the best has 0
};

enum class RankedBy : std::uint8_t {
    truth,    ///< F1 by frames; for a monitor its agreements on episodes and variants, on average
    decided,  ///< calibrated against both errors, so that these are bounded and the rest is
              ///< unknown: the share called rightly, averaged over what is true and what is false
    outcome,  ///< balanced accuracy of alarms; without failures, episodes without an alarm
};

struct RankedInTime {
    std::string name;  ///< of the predicate or monitor
    bool of_monitor = false;
    bool of_deadlines = false;  ///< of the monitor's phases, in their order
    RankedBy by = RankedBy::truth;
    std::vector<InTime> ranked;      ///< best first
    std::optional<double> clock{};   ///< F1 of the number of the step alone; predicates only
    std::optional<double> nested{};  ///< the score of what is the best on the other folds
};

/// Returns the titles of the parts of a monitor's scores.
std::array<std::string_view, 2> titles_of(const RankedInTime& ranking);

struct SuggestedInTime {
    std::vector<RankedInTime> all;
    std::size_t folds = 0;         ///< 0: nothing was trained
    std::string why_not;           ///< why nothing was tried; empty: it was
    std::string why_no_deadlines;  ///< likewise, of the deadlines
};

/// The text of a spec with all candidates, without its monitors.
struct TimeTrials {
    std::string text;
    std::vector<RankedInTime> all;  ///< in the order of the spec, without figures
};

/// `asked`: predicates to replace; `labelled`: those with a truth, which a formula may follow;
/// empty: all are judged by outcomes. Monitors over lets that have a truth, or too long to be
/// printed, are left as they are.
TimeTrials time_trials(const check::Model& model, const std::vector<check::Index>& asked,
                       const std::vector<check::Index>& labelled);

/// The conjuncts of each phase of a monitor, a, b, ... in F (a && F (b && ...)).
using Phases = std::vector<std::vector<check::Index>>;

/// Returns a deadline for each phase, at alpha = 0.1: the first within D, the next within D of it.
/// `phases`: per monitor; empty for other formulas.
TimeTrials deadline_trials(const check::Model& model, const std::vector<Phases>& phases);

/// Sorts the candidates by their scores, the best first.
void rank(RankedInTime& all);

struct Suggestion {
    std::string distance;  ///< description: "min l2(z, 8 medoids)"
    std::vector<std::string>
        lines;  ///< lines to paste in place of the predicate; empty: the predicate itself
    std::uint64_t elements = 0;  ///< elements compared per step, those of projections included
    episodes::Figure auroc{};    ///< undefined where it cannot be fitted
    std::string why_not{};       ///< the reason then
    bool ties = false;           ///< its interval overlaps that of the best
};

struct Suggestions {
    std::string predicate;
    std::vector<Suggestion> ranked;  ///< best first, then those that cannot be fitted
    /// Index into `ranked`: among those that tie with the best, the first that costs at most 10 %
    /// more than the cheapest.
    std::size_t recommended = 0;
};

struct Suggested {
    std::vector<Suggestions> of;
    std::vector<Index> predicates;  ///< parallel to `of`
    std::vector<Index> labelled;    ///< predicates with a truth
    SuggestedInTime in_time;        ///< filled in by the caller, who judges the trials
    std::size_t episodes = 0;
    std::uint64_t frames = 0;
    std::size_t folds = 0;
};

/// Checks a text in place of the spec's; returns nothing where it is invalid.
using CheckText = std::function<std::optional<check::Model>(const std::string& text)>;

/// `names`: predicates; empty: all that have labels and can be suggested for, or none of them where
/// there is something to suggest for monitors alone. Returns nothing after an error.
std::optional<Suggested> suggest(const check::Model& model, const CheckText& check_text,
                                 const std::vector<std::string>& names, bool of_monitors,
                                 const Request& request, diag::Sink& sink);

std::string report(const Suggested& suggested);
std::string json(const Suggested& suggested);

}  // namespace etlc::fit
