// `etlc fit --suggest`: which distances would separate a predicate, and what they cost.
// Takes: a spec, and episodes. Gives: candidates in the order of how well they separate on episodes
// that nothing was fitted on. Keeps true: what is measured is a spec of these very lines, by the
// way that `etlc fit` measures it, so the lines give the figures that stand beside them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"
#include "fit/readings.hpp"

namespace etlc::fit {

struct Suggestion {
    std::string distance;            ///< in words: "min l2(z, 8 medoids)"
    std::vector<std::string> lines;  ///< to paste in place of the predicate; empty: it is that
    std::uint64_t elements = 0;      ///< that a step compares, those of projections with them
    std::optional<episodes::Auroc> auroc;  ///< nothing: it cannot be fitted
    std::string why_not;                   ///< then
    bool ties = false;                     ///< its interval reaches that of the best
};

struct Suggestions {
    std::string predicate;
    std::vector<Suggestion> ranked;  ///< best first; behind them those that cannot be fitted
    /// Of `ranked`: among those that tie with the best, the first that costs no more than the
    /// cheapest and a tenth.
    std::size_t recommended = 0;
};

struct Suggested {
    std::vector<Suggestions> of;
    std::size_t episodes = 0;
    std::uint64_t frames = 0;
    std::size_t folds = 0;
};

/// The model of a text in place of the spec's; nothing where it is no spec.
using CheckText = std::function<std::optional<check::Model>(const std::string& text)>;

/// `names`: of predicates; none: all that have labels and can be suggested for. Nothing where the
/// sink now says why.
std::optional<Suggested> suggest(const check::Model& model, const CheckText& check_text,
                                 const std::vector<std::string>& names, const Request& request,
                                 diag::Sink& sink);

std::string report(const Suggested& suggested);
std::string json(const Suggested& suggested);

}  // namespace etlc::fit
