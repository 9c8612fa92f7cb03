// The thresholds file: what `etlc calibrate` found, and what it was computed from.
// Every float32 reads back to the same bits, and writing a file that was read gives the same text.
// check/ decides whether an entry fits the spec: it compares `reads`.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
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

/// A threshold and its scores.
struct Side {
    /// Infinite only if the entry is against both errors and the scores are too few for its rate.
    float epsilon = 0;
    /// Number of scores: groups of demonstrations (conformal, risk) or frames (class_conditional,
    /// f1).
    std::uint64_t n = 0;
    /// Rank of the score taken, from 1; n + 1 if epsilon is infinite; 0 for f1 and risk.
    std::uint64_t k = 0;
    std::vector<double> scores;  ///< may be infinite, not NaN
    /// Risk: the loss of each group at epsilon, and at the next tighter threshold (empty if none is
    /// tighter): shares in [0, 1].
    std::vector<double> losses;
    std::vector<double> losses_before;
};

/// The threshold of a predicate or the shift of a monitor: the only one, or of two the one beyond
/// which it is called false or violated.
struct Entry : Side {
    std::string method;  ///< f1, conformal, class_conditional, adaptive, risk
    std::string alpha;   ///< decimal text exactly as in the spec, a JSON number; empty for f1
    std::string beta;    ///< likewise, if the spec has it
    /// Everything the entry was computed from, by kind and name (check::Reads).
    std::map<std::string, std::string> reads;
    /// Predicates: empty (misses), false_positives or both; monitors: missed_alarm, missed_success
    /// or both.
    std::string against;
    std::uint64_t within = 0;  ///< steps around a change of the truth without labels
    /// Against both: the threshold within which it is called true or satisfied.
    std::optional<Side> inner;
    /// Normal: the scores as this machine measures them, without the margin of other builds; drifts
    /// compare them with those of new episodes.
    std::vector<double> measured;
    std::vector<std::uint64_t> episodes;  ///< monitors: hashes of the calibration episodes
    /// Monitors with a calibrated duration: that, in steps. Scores are durations too; there is no
    /// epsilon.
    std::optional<std::uint64_t> duration;
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
