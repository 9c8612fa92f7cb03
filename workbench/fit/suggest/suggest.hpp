// Suggests distances that separate a predicate, and their costs: `etlc fit --suggest`. Candidates
// are ranked by how well they separate on episodes that were not fitted on. The suggested lines are
// measured as `etlc fit` would measure them, so they give the figures beside them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"
#include "fit/collect.hpp"
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

// The distances that `etlc fit --suggest` tries for a predicate, with the declarations that they
// need, as lines of a spec. Names are new, and equal declarations are made once.

/// Returns all words of a spec, which include its names.
std::set<std::string> words_of(std::string_view spec);

/// Declarations under names that start with a prefix.
class Declarations {
public:
    /// Avoids the names in `taken`, and adds its own to them; `taken` outlives this.
    Declarations(std::string prefix, std::set<std::string>& taken)
        : prefix_(std::move(prefix)), taken_(taken) {}

    /// Returns the name of `kind NAME = text;`, and declares it, with the role as its end, if it is
    /// new.
    std::string name(const std::string& kind, const std::string& role, const std::string& text);
    /// Returns a new name.
    std::string unused(const std::string& wanted);

    const std::vector<std::string>& lines() const { return lines_; }

private:
    struct Declared {
        std::string kind, text, name;
    };

    std::string prefix_;
    std::set<std::string>& taken_;
    std::vector<Declared> declared_;
    std::vector<std::string> lines_;
};

/// The parts of a candidate, in words of the language.
struct Candidate {
    std::string_view map;       ///< method of the projection; empty: none
    std::uint32_t r = 0;        ///< its rows
    bool discriminant = false;  ///< a discriminant of the projection, or of the point
    std::string_view targets;   ///< method of the targets
    std::uint32_t k = 0;        ///< their rows; 0: one
    std::string_view distance;  ///< "mahalanobis": by the fitted metric
    bool contrast =
        false;  ///< minus the same distance to the frames at which the predicate does not hold
};

/// Returns the candidates that fit a point of this dimension.
std::vector<Candidate> candidates(std::uint32_t dimension);

/// Describes a candidate: "min l2(pca 16(z), 8 medoids), contrast".
std::string described(const Candidate& candidate, const std::string& point);

/// Returns the distance of the candidate, from `point`, to frames at which `predicate` holds.
std::string expression(const Candidate& candidate, const std::string& point,
                       const std::string& predicate, Declarations& declarations);

}  // namespace etlc::fit
