// Finds episodes of a call that overlap each other, or episodes that something was made from. Finds
// what data::Recordings would find among all, and keeps in memory only the candidates
// (data/traces/overlap.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "data/traces/overlap.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Episodes that something in a file was made from.
struct Source {
    data::KnownEpisodes contents;       ///< contents of these and of others
    std::vector<std::uint64_t> hashes;  ///< hashes of all of these
};

class OverlapSearch {
public:
    /// `each_other`: whether find_earlier will be called.
    OverlapSearch(const Identities& episodes, std::vector<Source> sources, bool each_other);

    /// Returns the overlap of `episode`, number `e` of the call, with source number `source`.
    std::optional<data::Overlap> find(std::size_t source, std::size_t e,
                                      const Recorded& episode) const;
    /// Returns the overlap with an earlier episode passed to this; `other` is its number in the
    /// call.
    std::optional<data::Overlap> find_earlier(std::size_t e, const Recorded& episode);

private:
    struct Seen {
        std::vector<std::uint64_t> hashes;  ///< sorted
        data::Recordings suspects;
    };
    std::vector<bool> is_suspect_;  ///< by number of the episode
    std::vector<Seen> seen_;        ///< by number of the source
    data::Recordings earlier_;
    std::vector<std::size_t> numbers_;  ///< numbers of these in the call
};

/// Counts of episodes that overlap an earlier one.
struct Overlaps {
    std::uint64_t repeated = 0;  ///< equal to an earlier one
    std::uint64_t overlapping = 0;
};
Overlaps overlaps(const Identities& episodes);

}  // namespace etlc::episodes
