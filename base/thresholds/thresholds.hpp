// The thresholds file: what `etlc calibrate` found, with where it came from.
// Takes: JSON of format 1 or 2. Gives: one entry per calibrated predicate. Keeps true: every
// float32 in it reads back to the same bits, and writing what was read gives the same text; whether
// an entry fits the spec is check/'s question, which compares `predicate` and `targets`.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "data/traces/known.hpp"
#include "diag/diag.hpp"
#include "thresholds/fields.hpp"
#include "thresholds/pieces.hpp"

namespace etlc::thresholds {

/// Larger files are refused: millions of episodes come to less, and temporary files take as much.
inline constexpr std::uint64_t kMaxFileBytes = 4ULL << 30U;
/// Of what stays in memory, the bytes of its text, and JSON values in a tree: all but "recordings"
/// and, of the values, what is in arrays of episodes and scores.
inline constexpr std::uint64_t kMaxKeptBytes = 64ULL << 20U;
inline constexpr std::uint64_t kMaxValues = 1ULL << 21U;

struct Entry {
    std::string method;  ///< f1, conformal, class_conditional
    std::string alpha;   ///< decimal text exactly as in the spec, a JSON number; empty for f1
    float epsilon = 0;   ///< finite
    /// Demonstrations (conformal) or frames (class_conditional, f1) that gave scores.
    std::uint64_t n = 0;
    std::uint64_t k = 0;         ///< rank of the score taken, 1 to n; 0 for f1
    std::vector<double> scores;  ///< may be infinite, not NaN
    std::string predicate;  ///< canonical text, check::Predicate::text; of a monitor the text of
                            ///< its formula
    std::string truth;  ///< what labels were: canonical text of the truth formula, "array", or both
    std::map<std::string, std::string> targets;  ///< target name -> content hash, 16 hex digits
    /// All that it was made from, by kind and name, check::Reads; empty in files of earlier
    /// versions.
    std::map<std::string, std::string> reads;
    std::string against;  ///< monitors: missed_alarm or missed_success
    /// Monitors: hashes of the episodes that it was calibrated on.
    std::vector<std::uint64_t> episodes;
};

struct File {
    std::uint32_t format = kFormat;
    std::string path;
    std::string spec;
    std::string etlc;  ///< version that wrote it
    std::map<std::string, Entry> predicates;
    std::map<std::string, Entry> monitors;
    /// Content hashes of the episodes behind `predicates`.
    std::vector<std::uint64_t> episodes;
    /// Of the episodes behind predicates and monitors, by content hash, what tells them apart;
    /// those that are not in it, from another version, are told apart by their hashes alone.
    data::KnownEpisodes recordings;
    std::vector<Allowance> allowances;  ///< of each call of `etlc calibrate` that made use of it
};

/// Of all episodes that some threshold was calibrated on.
std::vector<std::uint64_t> all_episodes(const File& file);

/// Those of episodes that no threshold in the file was calibrated on.
void drop_unused_recordings(File& file);

/// In words: "--allow-overlap passed over 3 episodes that share most of their content with another:
/// REASON".
std::string text(const Allowance& allowance);

/// Failures are E06; their messages name the key, not the path: `data::in_file`
/// (data/files/file.hpp) adds it.
diag::Result<File> read(const std::string& path);
diag::Result<File> parse(const std::string& json, const std::string& path);

/// JSON, two blanks of indentation a level, keys in a fixed order, a line feed at the end: a piece
/// after the other. False where `take` did not take one.
bool write(const File& file, const Pieces::Take& take);
std::string write(const File& file);

}  // namespace etlc::thresholds
