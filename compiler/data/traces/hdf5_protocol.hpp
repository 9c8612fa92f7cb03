// What etlc-read-hdf5 and etlc say to each other, over the reader's arguments and its standard
// output. `list FILE PATTERN`: a `name` record for each group that matches, sorted. `read FILE
// GROUP [WIDTH NAME MODE]...`, where MODE is "needed" or "optional": one `shapes` record, a line
// for each channel, "absent", "number DIMENSIONS..." or "bool DIMENSIONS..."; if every shape fits,
// `rows` records of doubles in the machine's order, the channels that are there side by side, as
// many rows as there are steps. Either ends with `end`, or with `failure`. Keeps true: a record is
// a tag, its length (32 bits, in the machine's order) and at most kMaxRecordBytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace etlc::data::hdf5 {

enum class Tag : char { name = 'N', shapes = 'S', rows = 'R', failure = 'F', end = 'E' };

/// The first byte of a failure's text.
enum class Cause : char { file = 'f', channel = 'c', array = 'a', elements = 'e' };

inline constexpr std::uint32_t kMaxRecordBytes = 16U << 20U;
inline constexpr std::size_t kBlockBytes = 256U
                                           << 10U;  ///< of rows; more where a single row is larger

inline constexpr std::string_view kNeeded = "needed";
inline constexpr std::string_view kOptional = "optional";

// The reader's own limits. An honest file needs a small part of them.
inline constexpr std::uint64_t kMaxMemoryBytes = 1ULL
                                                 << 30U;  ///< address space, libraries included
inline constexpr unsigned kMaxBlockSeconds = 30;          ///< of processor time, for each record
inline constexpr int kMaxSilenceSeconds = 120;            ///< of the clock, between two records
inline constexpr std::size_t kMaxNames = 1U << 20U;

}  // namespace etlc::data::hdf5
