// `etlc embed`: spec, images and videos in, embeddings and episodes out.
// Takes: the spec's text. Gives: the file of embeddings beside the spec, and an episode for every
// recording; of a shard, for every recording of it. Keeps true: all files appear or none, each
// whole; those of all shards are those of one process.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "check/check.hpp"
#include "diag/diag.hpp"
#include "driver/fleet/fleet.hpp"
#include "embed/embed.hpp"
#include "source/source.hpp"

namespace etlc::driver {

struct EmbedRequest {
    embed::Request embed;           ///< its version is set here
    std::vector<std::string> data;  ///< recordings
    std::string groups;             ///< of .h5 files, which are recordings
    /// Cameras of data sets and arrays, by input; of "" that of all inputs.
    std::map<std::string, std::string> cameras;
    std::string output;    ///< folder of the episodes
    std::string embedded;  ///< the file of embeddings; empty: beside the spec
    ShardRequest shard;    ///< which recordings; the first encodes the targets as well
    std::vector<check::Setting> settings;
};

/// False where the sink now says why not.
bool embed(const source::File& file, const EmbedRequest& request, diag::Sink& sink);

}  // namespace etlc::driver
