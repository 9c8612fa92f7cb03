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

/// All shards of a call, in any order, as one part. `paths`: of the parts, for messages. Nothing
/// where the sink now says why not, E1103 or E1104.
std::optional<Part> joined(std::vector<Part> parts, const std::vector<std::string>& paths,
                           diag::Sink& sink);

}  // namespace etlc::episodes
