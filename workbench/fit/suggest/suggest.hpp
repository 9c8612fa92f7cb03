// Suggests distances that separate a predicate, and their costs: `etlc fit --suggest`. Candidates
// are ranked by how well they separate on episodes that were not fitted on. The suggested lines are
// measured as `etlc fit` would measure them, so they give the figures beside them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"
#include "fit/readings.hpp"
#include "fit/suggest/in_time.hpp"

namespace etlc::fit {

struct Suggestion {
    std::string distance;  ///< description: "min l2(z, 8 medoids)"
    std::vector<std::string>
        lines;  ///< lines to paste in place of the predicate; empty: the predicate itself
    std::uint64_t elements = 0;  ///< elements compared per step, those of projections included
    std::optional<episodes::Auroc> auroc;  ///< empty where it cannot be fitted
    std::string why_not;                   ///< the reason then
    bool ties = false;                     ///< its interval overlaps that of the best
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

/// `names`: predicates; empty: all that have labels and can be suggested for. Returns nothing after
/// an error.
std::optional<Suggested> suggest(const check::Model& model, const CheckText& check_text,
                                 const std::vector<std::string>& names, const Request& request,
                                 diag::Sink& sink);

std::string report(const Suggested& suggested);
std::string json(const Suggested& suggested);

}  // namespace etlc::fit
