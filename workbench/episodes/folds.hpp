// Episodes dealt into folds, for cross-validation.
// Takes: what was read of every episode, and the number of folds. Gives: the fold of each. Keeps
// true: the content of the episodes alone decides, neither their names nor their order; folds are
// disjoint, and their sizes differ by at most one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// The episodes in the order of their hashes, which is that of no recording session.
std::vector<std::size_t> by_content(const Identities& episodes);

/// Per episode its fold, 0 to folds - 1: in that order, they are dealt in turn.
std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds);

/// Whether there are enough of them; reports where not, E0690. Any number can be dealt into 0
/// folds.
bool can_be_dealt(std::size_t episodes, std::uint32_t folds, const check::Model& model,
                  diag::Sink& sink);

/// Reads episodes for what tells them apart. Not shared between threads; all that it is given
/// outlives it.
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
