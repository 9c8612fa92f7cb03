// A part of a result: what one shard of a call made of its episodes, as a file.
// Takes: the call, the spec and what it loads, the list of episodes. Gives: the file's bytes; or
// the part, or all parts of a call as one. Keeps true: a file that was cut or changed is noticed;
// so are parts that are not of one call over the same data, a shard that is missing and one that is
// there twice.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"
#include "data/spill/spool.hpp"
#include "diag/diag.hpp"

namespace etlc::episodes {

inline constexpr std::uint32_t kMostShards = 1'000'000;

struct Part {
    std::string etlc;               ///< version that wrote it
    std::vector<std::string> call;  ///< the arguments, from the command on, without the shard
    std::string loaded;             ///< hash of the spec and of every file that it loads
    std::uint32_t shard = 0;        ///< 1 to `shards`
    std::uint32_t shards = 0;
    std::vector<std::string> episodes;             ///< all of the call, in order
    std::vector<check::Index> labelled;            ///< predicates, by what the first episode has
    std::map<std::uint64_t, std::string> results;  ///< packed, by place in `episodes`
};

template <class Archive>
void fields(Archive& archive, Part& part) {
    archive(part.etlc, part.call, part.loaded, part.shard, part.shards, part.episodes,
            part.labelled, part.results);
}

/// Which shard reads an episode of this content, 1 to `shards`.
constexpr std::uint32_t shard_of(std::uint64_t content, std::uint32_t shards) {
    return static_cast<std::uint32_t>(content % shards) + 1;
}

std::string write(const Part& part);
/// What `write` puts around the packed part.
std::string as_file(std::string_view body);
/// Failures are E1101 and E1102, and do not repeat the path.
diag::Result<Part> read_part(const std::string& path);
diag::Result<Part> parse_part(std::string_view bytes);

/// The shards of a call, in any order, as one part whose results are not in memory.
class Joined {
public:
    /// The next of them. `path`: of its file, for messages. False where the sink now says why it is
    /// none of the others' call, E1103, or is there twice, E1104.
    bool add(Part part, const std::string& path, diag::Sink& sink);
    /// False where one of them is missing, or an episode: the sink then says so, E1104.
    bool is_complete(diag::Sink& sink) const;

    /// Without results.
    const Part& call() const { return call_; }
    /// Packed, of an episode by its place.
    std::string result(std::size_t place) const { return results_[at_[place]]; }

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    Part call_;                                    ///< of the first
    std::string first_;                            ///< its path
    std::map<std::uint32_t, std::string> shards_;  ///< by number, their paths
    std::vector<std::uint32_t> at_;                ///< by place, which of the results
    data::Spool<std::string> results_;
};

// Episodes are shared out by a number of their content, so neither the names of files nor their
// order matter. Processes that keep the numbers in one file look at each episode once between them.

/// A hash of the size of the episode's file, its first and last 4 KiB and the group in it. The end
/// of an .npz file has checksums of its arrays.
std::uint64_t content_of(const std::string& episode);

/// Of all, in order. `kept`: a file that has them, or gets them; empty: none.
std::vector<std::uint64_t> contents_of(const std::vector<std::string>& episodes,
                                       const std::string& kept);

}  // namespace etlc::episodes
