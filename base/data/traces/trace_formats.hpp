// The formats behind open_trace, each from any source of bytes.
// Takes: channels, and an open file, an archive or arrays. Gives: the trace. Keeps true: shapes and
// element types fit the channels; failures have E08 codes and name the array.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "data/arrays/archive.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/traces/trace.hpp"

namespace etlc::data {

/// The column or array of the times of steps; no input can have this name. What is no number there
/// is missing, and an array that is not one number a step is absent.
inline constexpr std::string_view kTimes = "time";

/// Returns whether a channel asks for the times.
inline bool are_times(const Channel& channel) {
    return channel.optional && channel.name == kTimes;
}

diag::Result<std::unique_ptr<Trace>> open_csv_trace(std::unique_ptr<ByteSource> source,
                                                    const std::vector<Channel>& channels);

/// Opens the archive once per channel, so that all arrays are unpacked in step.
diag::Result<std::unique_ptr<Trace>> open_npz_trace(const std::string& path,
                                                    const std::vector<Channel>& channels);

/// Turns the E04 codes of archives and arrays into their E08 counterparts for traces.
diag::Failure of_trace(diag::Failure failure);

/// The rows of one .npy array, in order, in constant memory: `width` doubles a row, and a check
/// that nothing is left over. C order is read straight through. Of a Fortran-ordered array the
/// first row is complete only near the end of its bytes, so it is unpacked once to an unnamed
/// temporary file and read from there, a block of rows of every column.
class Rows {
public:
    virtual ~Rows() = default;
    /// Reads the next row. Must not be called after the last row.
    virtual diag::Result<const double*> next() = 0;
};

/// Takes a source behind its header, whose data are `rows` x `width`. Failures have E04 codes.
diag::Result<std::unique_ptr<Rows>> open_rows(std::unique_ptr<ByteSource> source,
                                              const NpyHeader& header, std::uint64_t rows,
                                              std::uint32_t width);

/// One channel and the array that feeds it.
struct Feed {
    Channel channel;
    std::uint64_t steps = 0;
    std::unique_ptr<Rows> rows;  ///< null: an optional channel that the file lacks
};

/// Fails where an array cannot feed the channel. Shapes are T or T x 1 for scalars and bools, T x D
/// for vectors, and T where D is 1; bool elements are for bools only.
std::optional<diag::Failure> check_array(const std::vector<std::uint64_t>& shape, bool has_bools,
                                         const Channel& channel);

/// Opens a trace of arrays, one per channel, in their order.
diag::Result<std::unique_ptr<Trace>> open_array_trace(std::vector<Feed> feeds);

}  // namespace etlc::data
