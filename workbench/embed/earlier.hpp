// Embeddings of an earlier call, with which an interrupted call goes on.
// Takes: a recording, and the episode that is on disk. Gives: the embeddings of an input that the
// episode already has. Keeps true: they are those that would be made again; contents decide, not
// names or times; embeddings that were changed, or whose origin cannot be told, are not taken.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "embed/encoder.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

class Earlier {
public:
    /// `version`: of etlc, which prepares the frames.
    Earlier(const Running& running, const std::string& version);

    /// Lists all that the embeddings of an input are made from, by hashes of contents; empty where
    /// it cannot be told. `encoder`: its fingerprint.
    std::string origin(const Recording& recording, const std::string& input,
                       const std::string& encoder);

private:
    /// Returns the hash of a file; empty where it cannot be read.
    std::string hash(const std::string& path, bool is_shared);

    std::string made_by_;  ///< version, and the command with its files, or the library of networks
    std::map<std::string, std::string> shared_;  ///< hashes of files with several recordings
};

/// Returns the hash that an episode stores for an input: of its origin and its embeddings.
std::string bound(const std::string& origin, std::uint32_t dimension,
                  const std::vector<float>& rows);

/// Returns the embeddings of an input in an episode; nothing where they are not of this origin.
std::optional<std::vector<float>> embeddings_in(const std::string& episode,
                                                const std::string& input, std::uint32_t dimension,
                                                const std::string& origin);

}  // namespace etlc::embed
