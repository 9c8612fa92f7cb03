// Labels for the episodes that nobody has labelled, from those that somebody has.
// Takes: a spec whose fitted entries are those of the labelled episodes, and the desk. Gives: for
// each other episode what the spec's predicates say of it, at their F1-optimal thresholds and less
// the delay with which they say it, and how doubtful that is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "label/desk.hpp"

namespace etlc::label {

/// Fewer labelled episodes give no proposals.
inline constexpr std::size_t kEnoughLabelled = 3;

struct Proposal {
    std::size_t episode = 0;
    /// Share of the frames, over the predicates, that are as near to the threshold as labelled
    /// frames that it misjudges; where it misjudges none, nearer than any labelled frame.
    double doubt = 0;
    std::vector<Marks> marks;  ///< per predicate; nothing where it needs none
};

struct Proposals {
    std::string why_none;         ///< why there are none, or none of a predicate; empty: there are
    std::vector<Proposal> found;  ///< the most doubtful first
};

/// Returns the proposals for all episodes that somebody has to label. Returns nothing after an
/// error.
std::optional<Proposals> propose(const check::Model& model, const Desk& desk,
                                 const recordings::NamesInFile& names, diag::Sink& sink);

/// Returns the episodes that all predicates are labelled in.
std::vector<std::string> labelled_episodes(const Desk& desk);

/// Writes labels as JSON, [[start, end, 1], ...] with 2 where nobody knows, null where nobody has
/// labelled; reads them. Nothing where the JSON is no labels of an episode of so many steps.
nlohmann::ordered_json json_of(const Marks& marks);
std::optional<Marks> marks_of(const nlohmann::ordered_json& json, std::uint64_t steps);
/// Writes proposals as JSON, on one line; reads them. Nothing where the text is none.
std::string text_of(const Proposals& proposals, const Desk& desk);
std::optional<Proposals> parse_proposals(const std::string& text, const Desk& desk);

}  // namespace etlc::label
