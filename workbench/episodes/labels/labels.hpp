// Labels beside recordings: from tables and from names of folders. A reader of episodes gets them
// as arrays `truth.NAME` of the episode.
// Takes: the tables, the episodes and the specs of a call. Gives: the labels of each episode, its
// group and its outcome. Keeps true: no label is used if any is in error; a label and an array of
// the episode, or two labels of one step, are an error that names both places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"
#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "episodes/cache/cache.hpp"
#include "recordings/open.hpp"

namespace etlc::episodes {

// Tables of labels: .csv files in which each row labels a predicate in steps of an episode.
// Takes: the bytes of a file. Gives: its rows, with their lines. Keeps true: a row is read exactly
// or refused; names of episodes and predicates are those of the file, which labels.hpp looks up.

/// Ordered: && is the minimum, || the maximum, unknown in between (Kleene's strong logic).
enum class Label : std::uint8_t { no, unknown, yes };

/// Says what became of a whole episode.
struct Outcome {
    enum class Kind : std::uint8_t {
        none,  ///< nobody says
        unknown,
        success,
        failure,
    };
    Kind kind = Kind::none;
    std::uint64_t failed_at = 0;  ///< the step of a failure; 0: not known, the last one counts

    bool operator==(const Outcome&) const = default;
    /// Whether what is learned from successes alone takes the episode: nobody calls it a failure,
    /// or says that its outcome is unknown.
    bool is_demonstration() const { return kind == Kind::none || kind == Kind::success; }
};

template <class Archive>
void fields(Archive& archive, Outcome& outcome) {
    archive(outcome.kind, outcome.failed_at);
}

/// Returns "success", and "" for none.
std::string_view name_of(Outcome::Kind kind);

/// The predicate has this label from `start` up to but excluding `end`.
struct LabelRow {
    std::string episode;
    std::string predicate;  ///< without its mark; empty where the row gives the group or outcome
    Label label = Label::yes;
    double start = 0;  ///< in steps or seconds; where the row gives an outcome, of the failure
    double end = std::numeric_limits<double>::infinity();
    std::string group;  ///< empty: none
    Outcome::Kind outcome = Outcome::Kind::none;
    std::uint32_t line = 0;
};

struct LabelTable {
    bool in_seconds = false;  ///< unit of `start` and `end`
    std::vector<LabelRow> rows;
};

/// Reads a table. Failures: E0803; E0860, which names the column, what was found and what was
/// expected.
diag::Result<LabelTable> parse_labels(std::unique_ptr<data::ByteSource> source);

// ---- names of episodes in tables ----------------------------------------------------------------
// Finds the episodes that a table of labels names.

/// Returns the folder that an episode lies in; for an episode of a data set, the data set.
std::string folder_of(const std::string& episode);

/// Returns the names of the folders that an episode lies in, from the root to its own: for an
/// episode of an .h5 file its groups too, behind the file; for one of a data set, the data set.
std::vector<std::string> folders_of(const std::string& episode);

/// The indices of the episodes that have a name: of one where the name is its whole path, of two
/// where it is ambiguous.
using Named = std::map<std::string, std::vector<std::size_t>>;

/// Fills in the episodes of each name. A name is the path of an episode, or an end of it that
/// begins with the name of a folder, file, group or data set; the ending of the file may be left
/// out, and zeros before the number of an episode of a data set.
void find_named(const std::vector<std::string>& episodes, Named& names);

/// Returns the shortest name of each episode that no other one has, nor one that lies where these
/// lie; the path where there is none.
std::vector<std::string> shortest_names(const std::vector<std::string>& episodes);

/// Lists the episodes that lie where these lie, and perhaps these too.
std::vector<std::string> neighbours_of(const std::vector<std::string>& episodes);

/// Returns whether a path that is relative to a folder, perhaps without its ending, is an episode.
bool is_episode_in(const std::string& folder, const std::string& name);

// ---- labels -------------------------------------------------------------------------------------

/// Labels besides those of tables.
enum class LabelBy : std::uint8_t {
    nothing,
    folder,   ///< folders are named after predicates or outcomes
    outcome,  ///< episodes say whether they succeeded
    subtask,  ///< rows of data sets are of subtasks that are named after predicates
};

/// Where the labels of a call are.
struct LabelSources {
    std::vector<std::string> tables;  ///< empty: labels.csv beside the episodes, if there is one
    LabelBy by = LabelBy::nothing;
    bool has_episodes = true;  ///< false where parts are merged: no episode is looked for
};

/// Steps from `start` up to but excluding `end` with this label.
struct LabelledSteps {
    static constexpr std::uint64_t kToTheEnd = std::numeric_limits<std::uint64_t>::max();

    std::uint64_t start = 0;
    std::uint64_t end = kToTheEnd;
    Label label = Label::yes;
    std::string place;  ///< "labels.csv:12"
};

/// Intervals in the order of their steps by the name of the predicate. No two overlap, and steps
/// outside are false.
using EpisodeLabels = std::map<std::string, std::vector<LabelledSteps>>;

/// Returns the step at or after a time. A time within a tenth of a step of one is that step, as for
/// the rows of data sets: tables have rounded decimals.
std::uint64_t step_at(double seconds, double step_seconds);

class LabelSet {
public:
    /// Reads the labels of these episodes. Steps of seconds are those of the models. Returns null
    /// where there are no labels, and after an error, which it reports.
    static std::shared_ptr<const LabelSet> read(const LabelSources& sources,
                                                const std::vector<const check::Model*>& models,
                                                const std::vector<std::string>& episodes,
                                                diag::Sink& sink);

    /// Returns whether some episode of the call has labels of the predicate.
    bool has(const std::string& predicate) const;
    /// Returns the labels of an episode; null where it has none.
    const EpisodeLabels* of(const std::string& episode) const;
    /// Returns the group of an episode; empty: it has none.
    std::string group_of(const std::string& episode) const;
    Outcome outcome_of(const std::string& episode) const;
    bool has_outcomes() const { return !outcomes_.empty(); }
    /// Returns the tables that were read.
    const std::vector<std::string>& tables() const { return tables_; }

private:
    friend class LabelReader;

    std::vector<std::string> tables_;
    std::map<std::string, EpisodeLabels> of_;  ///< by path of the episode
    std::map<std::string, std::string> groups_;
    std::map<std::string, Outcome> outcomes_;
};

/// How a call reads its episodes.
struct ReadOptions {
    recordings::NamesInFile names;           ///< names of inputs and labels in the files
    std::shared_ptr<const LabelSet> labels;  ///< null: none beside the files
    std::shared_ptr<TraceCache> cache;       ///< what was read; null: files are read each time
};

/// Opens an episode as recordings::open_trace does, with its labels as Boolean channels
/// `truth.NAME`. Fails with E0862 where the file has such an array too. At its end `next` fails
/// with E0861 where there are labels of later steps. `identities`: set to those of the episode if
/// it is kept.
diag::Result<std::unique_ptr<data::Trace>> open_labelled(
    const std::string& path, const std::vector<data::Channel>& channels, const ReadOptions& options,
    std::shared_ptr<IdentityCache>* identities = nullptr);

/// Makes labels unknown in the `within` steps before a change and in those from it on. Unknown
/// labels between two that differ are a change along their length; the ends are none.
void open_near_changes(std::vector<Label>& labels, std::uint32_t within);

/// Returns the groups of episodes, in order; empty where an episode has none.
std::vector<std::string> groups_of(const std::vector<std::string>& episodes,
                                   const ReadOptions& options);

}  // namespace etlc::episodes
