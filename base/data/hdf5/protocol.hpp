// What etlc-read-hdf5 and etlc say to each other, in the records of data/records/protocol.hpp.
// `list FILE PATTERN`: a `name` record for each group that matches, sorted. `read FILE GROUP [WIDTH
// NAME MODE]...`, where MODE is "needed" or "optional": one `shapes` record, a line for each
// channel, "absent", "number DIMENSIONS..." or "bool DIMENSIONS..."; if every shape fits, `rows`
// records of doubles in the machine's order, the channels that are there side by side, as many rows
// as there are steps. `images FILE GROUP NAME`: one `shapes` record of one line, "number
// DIMENSIONS..."; `rows` records of bytes, of which each image begins a new one. An empty NAME is
// the only dataset of images in the group.
#pragma once

#include <cstddef>
#include <string_view>

namespace etlc::data::hdf5 {

inline constexpr std::string_view kNeeded = "needed";
inline constexpr std::string_view kOptional = "optional";
inline constexpr std::size_t kMaxNames = 1U << 20U;

}  // namespace etlc::data::hdf5
