// The file that `etlc fit` writes: fitted projections, targets and metrics, and what they were
// computed from. It is an .npz archive with the member fitted.json and an array for each entry.
// All numbers are finite, and writing a file that was read gives the same bytes. check/ decides
// whether an entry fits the spec: it compares `declaration` and `reads`.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "artifacts/thresholds.hpp"

namespace etlc::fitted {

/// A frame of an episode.
struct Frame {
    std::uint64_t episode = 0;  ///< content hash
    std::uint64_t step = 0;
};

struct Entry {
    std::string name;         ///< the projection's or target's; for a metric its declaration
    std::string declaration;  ///< canonical text of `fitted(...)`
    /// Everything the entry was computed from, by kind and name (check::Reads).
    std::map<std::string, std::string> reads;
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    std::vector<float> matrix;   ///< rows x columns, row-major
    std::vector<float> offset;   ///< projections: one number per column; otherwise empty
    std::string hash;            ///< content_hash() of the entry; not in the file
    std::uint64_t frames = 0;    ///< number of frames it was fitted on
    std::vector<Frame> medoids;  ///< sources of the rows if they are frames; otherwise empty
};

struct File {
    std::string path;
    std::string spec;
    std::string etlc;  ///< version that wrote the file
    std::map<std::string, Entry> entries;
    std::vector<std::uint64_t> episodes;  ///< content hashes of the episodes behind the entries
    data::KnownEpisodes recordings;       ///< content that tells these episodes apart
    thresholds::GroupNames groups;
    std::vector<thresholds::Allowance> allowances;
};

/// Returns data::content_hash of the matrix, with the offset, if any, as a further row.
std::string content_hash(const Entry& entry);

/// Returns the default path of a spec's fitted file: SPEC.fitted.npz beside SPEC.etl.
std::string default_path(const std::string& spec_path);

/// Reads a fitted file. Failures have E04 and E06 codes; their messages name the key, and
/// `data::in_file` (data/files/file.hpp) adds the path.
diag::Result<File> read(const std::string& path);

/// Returns the bytes of the archive: fitted.json, and float32 arrays. The array of a projection or
/// target has its name, and its offset that name and "-offset"; metrics are "metric-1", "metric-2".
std::string write(const File& file);

}  // namespace etlc::fitted
