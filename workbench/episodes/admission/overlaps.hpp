// Episodes of a call that are like each other, or like those that something was made from.
// Takes: what was read of every episode, and the hashes and contents in files. Gives: for one after
// the other what it is like. Keeps true: it finds what data::Recordings would find among all, and
// keeps in memory only those that may be found (data/traces/suspects.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "data/traces/known.hpp"
#include "data/traces/overlap.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

/// Episodes that something in a file was made from.
struct Source {
    data::KnownEpisodes contents;       ///< of them and of others
    std::vector<std::uint64_t> hashes;  ///< of all of them
};

class OverlapSearch {
public:
    /// `each_other`: `find_earlier` will be asked.
    OverlapSearch(const Identities& episodes, std::vector<Source> sources, bool each_other);

    /// What `episode`, number `e` of the call, is like in source number `source`.
    std::optional<data::Overlap> find(std::size_t source, std::size_t e,
                                      const Recorded& episode) const;
    /// What it is like among those that this was asked about before; `other` is its number in the
    /// call.
    std::optional<data::Overlap> find_earlier(std::size_t e, const Recorded& episode);

private:
    struct Seen {
        std::vector<std::uint64_t> hashes;  ///< sorted
        data::Recordings suspects;
    };
    std::vector<bool> is_suspect_;  ///< by number
    std::vector<Seen> seen_;        ///< by source
    data::Recordings earlier_;
    std::vector<std::size_t> numbers_;  ///< of these
};

/// Episodes that are like an earlier one.
struct Overlaps {
    std::uint64_t repeated = 0;  ///< equal to it
    std::uint64_t overlapping = 0;
};
Overlaps overlaps(const Identities& episodes);

}  // namespace etlc::episodes
