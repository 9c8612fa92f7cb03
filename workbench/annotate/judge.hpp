// What the monitors of a spec say of the episodes of a data set, row by row.
// Takes: a spec and what of it is wanted. Gives: for each episode its success, its subtasks and its
// progress. Keeps true: the evaluator of `etlc run` steps the monitors, and each row is a step.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compile.hpp"
#include "diag/diag.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/open.hpp"

namespace etlc::annotate {

/// The annotations; an empty name or list: nothing.
struct Wanted {
    std::string success;                ///< a monitor
    bool undecided_is_false = false;    ///< an episode that it does not decide did not succeed
    std::vector<std::string> subtasks;  ///< predicates and lets
    std::string between = "none";       ///< the subtask of rows in which none of them holds
    std::string progress;               ///< a monitor of phases, F (a && F (b && ...))

    bool any() const { return !success.empty() || !subtasks.empty() || !progress.empty(); }
};

/// The way to the end of an episode at a row.
struct Place {
    std::uint32_t phase = 0;  ///< the number of phases that were reached
    float share = 0;          ///< of the way to the next, 0 to 1
};

struct Episode {
    enum class Outcome : std::uint8_t { undecided, failure, success };

    std::uint64_t rows = 0;
    Outcome outcome = Outcome::undecided;
    std::uint64_t succeeds = 0;  ///< the first row of which next.success is true
    /// The rows at which a subtask begins, row 0 first, with its place in Wanted::subtasks; a place
    /// behind the last of these: none of them holds.
    std::vector<std::pair<std::uint64_t, std::size_t>> subtasks;
    std::vector<Place> places;           ///< of all rows
    std::vector<std::uint64_t> reached;  ///< per phase that was reached, the row
};

struct Judged {
    std::map<std::uint64_t, Episode> episodes;  ///< by index; without those that are left out
    std::vector<std::string> phases;            ///< in words
    /// The progress before each phase, and 1: cumulative shares of the mean episode that reaches
    /// all phases; equal ones where none does.
    std::vector<double> steps;

    float progress(const Place& place) const;
};

/// Returns the path of the samples of an episode, which find_episodes gives as "pusht:000003": the
/// path itself, or in the folder of the episodes that `etlc embed` made of the set.
std::string samples_of(const std::string& episode, const std::string& made);

/// Steps the monitors through episodes of a data set, given by the paths of find_episodes.
/// Nothing after an error.
std::optional<Judged> judge(const Compiled& compiled, const CompileOptions& options,
                            const Wanted& wanted, const std::vector<std::string>& paths,
                            const std::string& made, const recordings::NamesInFile& names,
                            diag::Sink& sink);

}  // namespace etlc::annotate
