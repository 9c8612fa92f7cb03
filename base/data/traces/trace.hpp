// Recorded traces and episodes, read a step at a time.
// Takes: the columns wanted and a file (.npz, .csv or .h5; FILE.h5:GROUP is the episode in a group
// of it, FOLDER:3 an episode of a data set, data/datasets/trace.hpp). Gives: one sample a step,
// missing ones marked. Keeps true: memory does not grow with the number of steps (.csv is streamed;
// of an .npz member only a buffer is held, a Fortran-ordered T x D array is first unpacked to an
// unnamed temporary file in $TMPDIR or /tmp; .h5 is read by a process of its own,
// data/traces/hdf5.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// One column group of a trace: a scalar (`width` 1, written `name`), an embedding (`name[0]`,
/// `name[1]`, ... in CSV, an array T x width in NPZ and HDF5) or a bool (0/1, or a bool array).
struct Channel {
    enum class Kind : std::uint8_t { scalar, boolean, vector };
    std::string name;
    Kind kind = Kind::scalar;
    std::uint32_t width = 1;
    /// Where the file lacks it, it is missing at every step, and `Trace::has` says so.
    bool optional = false;
};

/// One step of all channels. Values keep the file's precision; narrowing them is the reader's
/// user's business.
struct Sample {
    /// Per channel, `width` numbers; NaN where the cell was not finite.
    std::vector<std::vector<double>> values;
    std::vector<bool> present;  ///< per channel: false for an empty cell or a partly empty vector
};

class Trace {
public:
    virtual ~Trace() = default;
    /// Reads the next step into `sample`; false at the end of the trace.
    virtual diag::Result<bool> next(Sample& sample) = 0;
    /// Number of steps where the file tells it beforehand, else 0: for progress.
    virtual std::uint64_t length() const { return 0; }
    /// Whether the file has this channel; false for optional ones only.
    virtual bool has(std::size_t channel) const = 0;
};

/// Names in the file, by the names of the channels, where they differ: `--map z=obs/z`.
using NamesInFile = std::map<std::string, std::string>;
std::vector<Channel> renamed(std::vector<Channel> channels, const NamesInFile& names);
const std::string& name_in_file(const std::string& name, const NamesInFile& names);

/// Whether the ending of a path is that of a trace.
bool is_trace(const std::string& path);
/// The endings of traces: ".csv, .npz, .h5 or .hdf5".
std::string trace_endings();

/// The path of a trace that comes on standard input, as CSV. It is read once.
inline constexpr std::string_view kStandardInput = "-";

/// Of FILE.h5:GROUP the file, of an episode of a data set its folder, of any other path the path
/// itself.
std::string trace_file(const std::string& path);

/// A trace that ends before its first step: neither verdicts nor thresholds come of it.
diag::Failure no_steps();

/// The finding as a diagnostic whose place is the trace; where something is looked for by the wrong
/// name, it says how to give another.
diag::Diagnostic in_trace(const diag::Failure& failure, const std::string& path);

/// Opens a trace. Every channel that is not optional must be there; extra columns and arrays are
/// ignored, but not elements of a vector beyond its width. Shapes in .npz and .h5: T or T x 1 for
/// scalars and bools, T x D for vectors (T too where D is 1). Failures, here and in `next`, are
/// E08; their messages do not repeat the path: `in_trace` adds it.
diag::Result<std::unique_ptr<Trace>> open_trace(const std::string& path,
                                                const std::vector<Channel>& channels);

}  // namespace etlc::data
