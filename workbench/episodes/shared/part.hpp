// A part of a result: the file that one shard of a call makes of its episodes. Detects files that
// were truncated or changed, parts of different calls or data, and missing or repeated shards.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"
#include "data/spill/spill.hpp"
#include "diag/diag.hpp"

namespace etlc::episodes {

inline constexpr std::uint32_t kMostShards = 1'000'000;

struct Part {
    std::string etlc;               ///< version of etlc
    std::vector<std::string> call;  ///< arguments from the command on, without the shard
    std::string loaded;             ///< hash of the spec and of all files that it loads
    std::uint32_t shard = 0;        ///< 1 to `shards`
    std::uint32_t shards = 0;
    std::vector<std::string> episodes;   ///< all episodes of the call, in order
    std::vector<check::Index> labelled;  ///< labelled predicates, according to the first episode
    std::map<std::uint64_t, std::string> results;  ///< packed, by place in `episodes`
};

template <class Archive>
void fields(Archive& archive, Part& part) {
    archive(part.etlc, part.call, part.loaded, part.shard, part.shards, part.episodes,
            part.labelled, part.results);
}

/// Returns the shard, 1 to `shards`, that reads an episode of this content.
constexpr std::uint32_t shard_of(std::uint64_t content, std::uint32_t shards) {
    return static_cast<std::uint32_t>(content % shards) + 1;
}

std::string write(const Part& part);
/// Wraps a packed part as a file.
std::string as_file(std::string_view body);
/// Reads a part. Failures are E1101 and E1102, and do not repeat the path.
diag::Result<Part> read_part(const std::string& path);
diag::Result<Part> parse_part(std::string_view bytes);

/// Joins the shards of a call, in any order; results stay out of memory.
class Joined {
public:
    /// Adds a shard; `path` is for messages. Returns false after reporting that it belongs to
    /// another call, E1103, or is repeated, E1104.
    bool add(Part part, const std::string& path, diag::Sink& sink);
    /// Returns false after reporting a missing shard or episode, E1104.
    bool is_complete(diag::Sink& sink) const;

    /// Returns the call, without results.
    const Part& call() const { return call_; }
    /// Returns the packed result of an episode by its place.
    std::string result(std::size_t place) const { return results_[at_[place]]; }

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    Part call_;                                    ///< from the first shard
    std::string first_;                            ///< path of the first shard
    std::map<std::uint32_t, std::string> shards_;  ///< paths by number of the shard
    std::vector<std::uint32_t> at_;                ///< index of the result, by place
    data::Spool<std::string> results_;
};

// Episodes are distributed by a number of their content, so neither names of files nor their order
// matter. Processes that share a file of these numbers read each episode once between them.

/// Returns a hash of the size of the episode's file, its first and last 4 KiB and the group in it.
/// The end of an .npz file has checksums of its arrays.
std::uint64_t content_of(const std::string& episode);

/// Returns the numbers of all episodes, in order. `kept`: a file to read them from, or to write
/// them to; empty: none.
std::vector<std::uint64_t> contents_of(const std::vector<std::string>& episodes,
                                       const std::string& kept);

}  // namespace etlc::episodes
