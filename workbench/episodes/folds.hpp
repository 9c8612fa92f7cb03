// Deals episodes into folds for cross-validation. Only their content decides, not their names or
// their order. Folds are disjoint, and their sizes differ by at most one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Returns the episodes in the order of their hashes, which does not follow recording sessions.
std::vector<std::size_t> by_content(const Identities& episodes);

/// Returns the fold of each episode, 0 to folds - 1: they are dealt in turn, in the order of
/// by_content.
std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds);

/// Returns whether there are enough episodes, and reports E0690 where not. 0 folds always fit.
bool can_be_dealt(std::size_t episodes, std::uint32_t folds, const check::Model& model,
                  diag::Sink& sink);

/// Reads the identity of episodes. Not thread-safe; the arguments outlive it.
class ContentScorer {
public:
    ContentScorer(const check::Model& model, const data::NamesInFile& names);

    /// Failures do not name the path.
    diag::Result<Recorded> score(const std::string& path) const;

private:
    Wanted wanted_;
    const data::NamesInFile& names_;
};

}  // namespace etlc::episodes
