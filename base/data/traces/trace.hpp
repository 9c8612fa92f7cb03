// Recorded traces and episodes, read a step at a time, and their paths.
// Takes: the columns wanted and a file (.npz, .csv or .h5; FILE.h5:GROUP is the episode in a group
// of it, FOLDER:3 an episode of a data set). Gives: one sample a step, missing ones marked. Keeps
// true: memory does not grow with the number of steps (.csv is streamed; of an .npz member only a
// buffer is held, a Fortran-ordered T x D array is first unpacked to an unnamed temporary file in
// $TMPDIR or /tmp; .h5 is read by a separate process).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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
    /// Where the file lacks it, all samples are missing, and `Trace::has` returns false.
    bool optional = false;
};

/// One step of all channels, in the precision of the file.
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
    /// Returns the number of steps where the file declares it, else 0: for progress.
    virtual std::uint64_t length() const { return 0; }
    /// Returns whether the file has this channel; false for optional ones only.
    virtual bool has(std::size_t channel) const = 0;
};

/// Opens a trace by its path. Failures do not repeat the path.
using OpenTrace = diag::Result<std::unique_ptr<Trace>> (*)(const std::string& path,
                                                           const std::vector<Channel>& channels);

bool is_hdf5(const std::string& path);

/// Returns whether a folder is a data set.
bool is_dataset(const std::string& folder);

/// "pusht:3", or "pusht:0:50" for the episodes from 0 to 49: the folder and the range.
struct DatasetPath {
    std::string folder;
    std::uint64_t first = 0;
    std::uint64_t end = UINT64_MAX;
};
/// Parses such a path; nothing where the folder is not a data set.
std::optional<DatasetPath> dataset_path(const std::string& path);

/// Returns the file of FILE.h5:GROUP, the folder of an episode of a data set, and any other path
/// unchanged.
std::string trace_file(const std::string& path);

}  // namespace etlc::data
