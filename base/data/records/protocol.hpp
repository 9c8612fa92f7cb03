// What etlc and its readers, programs that read what may be hostile, say to each other.
// Takes: the arguments of the reader. Gives: records on its standard output, ended by `end` or by
// `failure`. Keeps true: a record is a tag, its length (32 bits, in the machine's order) and at
// most kMaxRecordBytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace etlc::data::records {

enum class Tag : char { name = 'N', shapes = 'S', rows = 'R', failure = 'F', end = 'E' };

/// The first byte of a failure's text.
enum class Cause : char { file = 'f', channel = 'c', array = 'a', elements = 'e' };

inline constexpr std::uint32_t kMaxRecordBytes = 16U << 20U;
inline constexpr std::size_t kBlockBytes = 256U
                                           << 10U;  ///< of rows; more where a single row is larger

// The reader's own limits. An honest file needs a small part of them.
inline constexpr std::uint64_t kMaxMemoryBytes = 1ULL
                                                 << 30U;  ///< address space, libraries included
inline constexpr unsigned kMaxBlockSeconds = 30;          ///< of processor time, for each record
inline constexpr int kMaxSilenceSeconds = 120;            ///< of the clock, between two records

}  // namespace etlc::data::records
