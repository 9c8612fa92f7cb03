// Recorded traces and episodes, read a step at a time.
// Takes: the columns wanted and a file (.npz, .csv or .h5; FILE.h5:GROUP is the episode in a group
// of it, FOLDER:3 an episode of a data set, data/datasets/trace.hpp). Gives: one sample a step,
// missing ones marked. Keeps true: memory does not grow with the number of steps (.csv is streamed;
// of an .npz member only a buffer is held, a Fortran-ordered T x D array is first unpacked to an
// unnamed temporary file in $TMPDIR or /tmp; .h5 is read by a process of its own,
// data/hdf5/hdf5.hpp).
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

}  // namespace etlc::data
