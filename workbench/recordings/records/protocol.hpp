// The protocol between etlc and its readers, programs that read files which may be hostile.
// A reader takes arguments and writes records to its standard output, the last of which is `end` or
// `failure`. A record is a tag, a length (32 bits, in the machine's order) and at most
// kMaxRecordBytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace etlc::recordings::records {

enum class Tag : char { name = 'N', shapes = 'S', rows = 'R', failure = 'F', end = 'E' };

/// The first byte of a failure's text.
enum class Cause : char { file = 'f', channel = 'c', array = 'a', elements = 'e' };

inline constexpr std::uint32_t kMaxRecordBytes = 16U << 20U;
/// The size of a record of rows; more where a single row is larger.
inline constexpr std::size_t kBlockBytes = 256U << 10U;

// Limits of the reader. An ordinary file needs a small part of them.
/// Address space, libraries included.
inline constexpr std::uint64_t kMaxMemoryBytes = 1ULL << 30U;
inline constexpr unsigned kMaxBlockSeconds = 30;  ///< of processor time, for each record
inline constexpr int kMaxSilenceSeconds = 120;    ///< of the clock, between two records

// etlc-read-hdf5 has three calls.
// `list FILE PATTERN`: a `name` record for each group that matches, sorted.
// `read FILE GROUP [WIDTH NAME MODE]...`, where MODE is "needed", "optional", or "times", which is
// absent where it is not a number for each step of the channels before it: one `shapes` record, a
// line for each channel, "absent", "number DIMENSIONS..." or "bool DIMENSIONS..."; if every shape
// fits, `rows` records of doubles in the machine's order, the channels that exist side by side, as
// many rows as there are steps.
// `images FILE GROUP NAME`: one `shapes` record of one line, "number DIMENSIONS..."; `rows` records
// of bytes, of which each image begins a new one. An empty NAME is the only dataset of images in
// the group.
inline constexpr std::string_view kNeeded = "needed";
inline constexpr std::string_view kOptional = "optional";
inline constexpr std::string_view kTimes = "times";
inline constexpr std::size_t kMaxNames = 1U << 20U;

// etlc-read-parquet has one call.
// `read FILE KEY VALUE NAME...`: one `shapes` record, a line for each name, "absent", or "number",
// "bool" or "text", with " list" behind it where a row has a list; then `rows` records of the rows
// whose column KEY is VALUE, of all where KEY is empty. A row has a cell for each column that
// exists: the number of its values (32 bits; kNullCell: the cell is null), then each value as a
// double, or as the length (32 bits) and the bytes of a text, in the machine's order.
inline constexpr std::uint32_t kNullCell = 0xffffffff;

// The reader's side of the records, which it writes to standard output.
// Keeps true: memory, files and time of the process are limited before a file is opened; every
// record renews the limit of processor time, so long files are read and endless loops end.

/// Limits the process. `mapped`: bytes of a mapped file, which take address space only.
void limit_resources(std::uint64_t mapped = 0);

void send(Tag tag, const char* bytes, std::size_t n);
void send(Tag tag, const std::string& text);

/// Exits without the cleanup of libraries, which a damaged file may have broken.
[[noreturn]] void quit(int status);
[[noreturn]] void fail(Cause cause, const std::string& text);
[[noreturn]] void done();

}  // namespace etlc::recordings::records
