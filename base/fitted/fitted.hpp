// The file of fitted things: what `etlc fit` found, with where it came from.
// Takes: an .npz archive of format 1 or 2: the member fitted.json, and an array for every entry.
// Gives: one entry per fitted projection, target or metric. Keeps true: writing what was read gives
// the same bytes; all numbers are finite; whether an entry fits the spec is check/'s question,
// which compares `declaration`, `of` and `truth`.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "data/traces/known.hpp"
#include "diag/diag.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::fitted {

/// A frame of an episode.
struct Frame {
    std::uint64_t episode = 0;  ///< content hash
    std::uint64_t step = 0;
};

struct Entry {
    std::string name;         ///< of the projection or target; of a metric its declaration
    std::string declaration;  ///< canonical text of `fitted(...)`
    /// What the point goes through: canonical text, and content hashes of the projections in it.
    std::string of;
    std::string truth;  ///< canonical text of `where`, and what the labels in it were
    /// All that it was made from, by kind and name, check::Reads; empty in files of earlier
    /// versions.
    std::map<std::string, std::string> reads;
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    std::vector<float> matrix;   ///< rows x columns, row-major
    std::vector<float> offset;   ///< of projections: columns; else empty
    std::string hash;            ///< of matrix and offset, content_hash(); not in the file
    std::uint64_t frames = 0;    ///< that it was fitted on
    std::vector<Frame> medoids;  ///< where the rows come from, if they are frames; else empty
};

struct File {
    std::uint32_t format = thresholds::kFormat;
    std::string path;
    std::string spec;
    std::string etlc;  ///< version that wrote it
    std::map<std::string, Entry> entries;
    /// Content hashes of the episodes behind the entries.
    std::vector<std::uint64_t> episodes;
    data::KnownEpisodes recordings;  ///< what tells them apart
    std::vector<thresholds::Allowance> allowances;
};

/// data::content_hash of the matrix, with the offset as one row more where there is one.
std::string content_hash(const Entry& entry);

/// Where the fitted things of a spec are looked for: SPEC.fitted.npz beside SPEC.etl.
std::string default_path(const std::string& spec_path);

/// Failures are E04 and E06; their messages name the key, not the path: `data::in_file`
/// (data/files/file.hpp) adds it.
diag::Result<File> read(const std::string& path);
/// The same from memory.
diag::Result<File> parse(std::string_view bytes, const std::string& path);

/// The bytes of the archive: fitted.json, and float32 arrays. The array of a projection or target
/// has its name, and its offset that name and "-offset"; metrics are "metric-1", "metric-2", ...
std::string write(const File& file);

}  // namespace etlc::fitted
