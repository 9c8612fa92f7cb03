// By what episodes are shared out among shards.
// Takes: episodes. Gives: a number for each, that of its content, so that neither the names of
// files nor their order matter. Keeps true: processes that keep the numbers in one file look at
// each episode once between them; without such a file, or with one of other episodes, each looks by
// itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace etlc::episodes {

/// Of the size of the episode's file, its first and last 4 KiB and the group in it. The end of an
/// .npz file has checksums of its arrays.
std::uint64_t content_of(const std::string& episode);

/// Of all, in order. `kept`: a file that has them, or gets them; empty: none.
std::vector<std::uint64_t> contents_of(const std::vector<std::string>& episodes,
                                       const std::string& kept);

}  // namespace etlc::episodes
