// The thresholds file: what `etlc calibrate` found, and what it was computed from.
// Every float32 reads back to the same bits, and writing a file that was read gives the same text.
// check/ decides whether an entry fits the spec: it compares `reads`.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "data/traces/overlap.hpp"
#include "diag/diag.hpp"

namespace etlc::thresholds {

/// The format of files that list episodes: of thresholds, and of what was fitted.
inline constexpr std::uint32_t kFormat = 3;

/// One use of `--allow-overlap REASON`.
struct Allowance {
    std::string reason;
    std::uint64_t overlapping = 0;  ///< episodes that share most of their content with another
    std::uint64_t leaked = 0;       ///< episodes with a target among their frames
};

/// The group of each episode that has one, by content hash in 16 hex digits.
using GroupNames = std::map<std::string, std::string>;

struct Entry {
    std::string method;  ///< f1, conformal, class_conditional, adaptive
    std::string alpha;   ///< decimal text exactly as in the spec, a JSON number; empty for f1
    float epsilon = 0;   ///< finite
    /// Number of scores: groups of demonstrations (conformal) or frames (class_conditional, f1).
    std::uint64_t n = 0;
    std::uint64_t k = 0;         ///< rank of the score taken, 1 to n; 0 for f1
    std::vector<double> scores;  ///< may be infinite, not NaN
    /// Everything the entry was computed from, by kind and name (check::Reads).
    std::map<std::string, std::string> reads;
    std::string against;                  ///< monitors: missed_alarm or missed_success
    std::vector<std::uint64_t> episodes;  ///< monitors: hashes of the calibration episodes
};

struct File {
    std::string path;
    std::string spec;
    std::string etlc;  ///< version that wrote the file
    std::map<std::string, Entry> predicates;
    std::map<std::string, Entry> monitors;
    std::vector<std::uint64_t> episodes;  ///< content hashes of the episodes behind `predicates`
    /// Content that tells the episodes of predicates and monitors apart, by content hash.
    data::KnownEpisodes recordings;
    GroupNames groups;
    std::vector<Allowance> allowances;  ///< one per call of `etlc calibrate` that needed it
};

/// Returns the hashes of all episodes that some threshold was calibrated on.
std::vector<std::uint64_t> all_episodes(const File& file);

/// Removes the recordings, and their groups, that no threshold in the file was calibrated on.
void drop_unused_recordings(File& file);

/// Returns whether some of the episodes has a group, and the number of groups, among which every
/// episode without one counts.
struct GroupCount {
    bool any_named = false;
    std::uint64_t groups = 0;
};
GroupCount count_groups(const std::vector<std::uint64_t>& episodes, const GroupNames& names);

/// Describes an allowance: "--allow-overlap passed over 3 episodes that share most of their content
/// with another: REASON".
std::string text(const Allowance& allowance);

/// Read a thresholds file. Failures have E06 codes; their messages name the key, and
/// `data::in_file` (data/files/file.hpp) adds the path.
diag::Result<File> read(const std::string& path);
diag::Result<File> parse(const std::string& json, const std::string& path);

/// Write JSON with two blanks of indentation a level, keys in a fixed order and a line feed at the
/// end. The first passes it to `take` piece by piece, and returns false when `take` does.
bool write(const File& file, const std::function<bool(std::string_view)>& take);
std::string write(const File& file);

}  // namespace etlc::thresholds
