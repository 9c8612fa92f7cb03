// Deals episodes into folds for cross-validation. Their content and their groups decide, not their
// names or their order. Folds are disjoint, and no group is in two. Without groups their sizes
// differ by at most one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Returns the episodes in the order of their hashes, which does not follow recording sessions.
std::vector<std::size_t> by_content(const Identities& episodes);

/// Deals episodes whose groups are given, empty for none: the groups in turn, the largest first,
/// each to the fold that has the fewest episodes. An episode without a group is dealt by itself.
std::vector<std::uint32_t> dealt(const std::vector<std::string>& groups, std::size_t folds);

/// Returns the number of groups and of episodes without one.
std::size_t count_apart(const std::vector<std::string>& groups);

/// Returns the fold of each episode, 0 to folds - 1: they are dealt in the order of by_content.
std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds,
                                    const ReadOptions& reading = {});

/// Returns whether there are enough episodes and groups, and reports E0690 where not. 0 folds
/// always fit.
bool can_be_dealt(const std::vector<std::string>& episodes, const ReadOptions& reading,
                  std::uint32_t folds, const check::Model& model, diag::Sink& sink);

/// Reads the identity of episodes. Not thread-safe; the arguments outlive it.
class ContentScorer {
public:
    /// `labelled`: predicates whose labels are read too, if episodes are kept for later stages, as
    /// are all inputs; what is wrong with these is left to them.
    ContentScorer(const check::Model& model, const ReadOptions& reading,
                  std::vector<Index> labelled);

    /// Failures do not name the path.
    diag::Result<Recorded> score(const std::string& path) const;

private:
    diag::Result<Recorded> read(const Wanted& wanted, const std::string& path) const;

    Wanted wanted_;
    std::optional<Wanted> for_later_;
    const ReadOptions& reading_;
};

}  // namespace etlc::episodes
