// The contents of many episodes by their hashes.
// Takes: hashes and contents, in any order. Gives: them in ascending order of the hashes, each
// once, the last that was added. Keeps true: contents are in temporary files, and memory does not
// grow with their number; a copy costs nothing until one of the two changes. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "data/spill/file.hpp"
#include "data/spill/sorted.hpp"
#include "data/traces/overlap.hpp"

namespace etlc::data {

class KnownEpisodes {
public:
    void add(std::uint64_t hash, const EpisodeContent& content);
    bool empty() const { return all_ == nullptr || all_->places.size() == 0; }

    using Visit = std::function<void(std::uint64_t hash, const EpisodeContent& content)>;
    void for_each(const Visit& visit) const;
    /// Visits only those among `hashes`, which are sorted.
    void for_each_of(const std::vector<std::uint64_t>& hashes, const Visit& visit) const;

    /// Forgets all that are not among `hashes`, which are sorted.
    void keep(const std::vector<std::uint64_t>& hashes);

private:
    struct Place {
        std::uint64_t hash;
        std::uint64_t at;  ///< place of its length, which precedes the content
        bool operator<(const Place& other) const {
            return hash != other.hash ? hash < other.hash : at < other.at;
        }
    };
    struct All {
        SpillFile contents;
        Sorted<Place> places;
    };

    static EpisodeContent read(const SpillFile& contents, std::uint64_t at);

    std::shared_ptr<All> all_;  ///< shared by copies until one of them changes
};

}  // namespace etlc::data
