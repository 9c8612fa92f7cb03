// Groups of episodes that resemble each other, and folds for cross-validation. What is stated about
// episodes counts each group once: its episodes are not independent. Content and groups decide into
// which fold episodes are dealt, not their names or their order. Folds are disjoint, and no group
// is in two. Without groups their sizes differ by at most one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Numbers the groups of episodes that are added in order. An episode without a group is one by
/// itself.
class Groups {
public:
    Groups() = default;
    /// Takes the names of the groups, empty for none.
    explicit Groups(const std::vector<std::string>& names) {
        for (const std::string& name : names) add(name);
    }
    explicit Groups(const Identities& episodes) {
        episodes.for_each([&](std::size_t, const Recorded& episode) { add(episode.group); });
    }

    /// Adds an episode, and returns the number of its group.
    std::uint32_t add(const std::string& name);

    std::uint32_t of(std::size_t episode) const { return of_[episode]; }
    std::size_t episodes() const { return of_.size(); }
    std::uint32_t count() const { return count_; }
    /// Returns whether some episode has a group: without one, groups are episodes.
    bool are_named() const { return !known_.empty(); }

private:
    std::vector<std::uint32_t> of_;  ///< per episode
    std::map<std::string, std::uint32_t> known_;
    std::uint32_t count_ = 0;
};

/// Returns the episodes in the order of their hashes, which does not follow recording sessions.
std::vector<std::size_t> by_content(const Identities& episodes);

/// Deals episodes whose groups are given, empty for none: the groups in turn, the largest first,
/// each to the fold that has the fewest episodes. An episode without a group is dealt by itself.
std::vector<std::uint32_t> dealt(const std::vector<std::string>& groups, std::size_t folds);

/// Returns the fold of each episode, 0 to folds - 1: they are dealt in the order of by_content.
std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds);
/// Returns the fold of each group.
std::vector<std::uint32_t> folds_of(const Identities& episodes, const Groups& groups,
                                    std::uint32_t folds);

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
