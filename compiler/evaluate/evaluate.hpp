// `etlc evaluate`: the monitors of a spec against ground truth, on recorded episodes.
// Takes: the compiled spec and the episodes. Gives: counts and rates per predicate and monitor,
// each with its interval and next to the baselines that ignore the data. Keeps true: the result is
// the same whatever the number of threads; one episode a thread is open at a time; episodes that
// thresholds were calibrated on are refused.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "evaluate/bootstrap.hpp"
#include "evaluate/episode_scores.hpp"
#include "evaluate/subject.hpp"
#include "pipeline/compile.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::evaluate {

struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    data::NamesInFile names;
    std::string allow_overlap;  ///< the reason for which overlaps with the episodes of calibration
                                ///< are passed over; empty: they are not
    unsigned jobs = 0;          ///< threads; 0: as many as the machine has
    plan::Limits limits;        ///< of the ground truth's plan
    /// Called now and then, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Counts of claims, with intervals over episodes.
struct Score {
    Counts counts;
    Figure f1;
    Figure precision;
    Figure recall;
    Figure agreement;
};

struct PredicateScore {
    std::string name;
    bool adaptive = false;  ///< with the threshold that it starts with: nothing gives labels here
    Score frames;
    Figure auroc;     ///< of the distance, whatever the threshold
    Figure coverage;  ///< of the episodes with a positive frame, those of which none is missed
    std::uint64_t unmeasured = 0;  ///< labelled frames whose distance is unknown: misses
    std::uint64_t arrays = 0;      ///< episodes whose labels come from an array of theirs
};

/// When the true verdict turned away from that of the first step, and the monitor's with it.
struct Detection {
    std::uint64_t turns = 0;  ///< episodes in which it did
    std::uint64_t missed = 0;
    std::uint64_t early = 0;  ///< the monitor turned before
    Figure mean;              ///< steps from turn to turn, of those that were not missed
    std::optional<double> median;
};

struct MonitorScore {
    std::string name;
    std::vector<std::string> lacking;  ///< predicates without truth; then nothing else is set
    Score steps;
    Score episodes;
    Detection detection;
    /// Sequential formulas: episodes in which every stage was truly visited.
    std::optional<Score> ordering;
};

struct Evaluation {
    std::uint64_t episodes = 0;
    std::uint64_t frames = 0;
    std::uint64_t repeated = 0;     ///< episodes with the content of an earlier one
    std::uint64_t leaked = 0;       ///< episodes with a frame that is a row of a target
    std::uint64_t overlapping = 0;  ///< episodes that share most of their content with another
    std::vector<std::string> reservations;  ///< what was passed over, in words
    double step_seconds = 0;                ///< 0: the spec has no rate
    std::vector<PredicateScore> predicates;
    std::vector<MonitorScore> monitors;
};

/// Predicates are held to the truth that the spec has, or an array in the first episode. `seen`:
/// the thresholds that the plan has, where they were calibrated; the episodes in it are refused.
/// Nothing where the sink now says why.
std::optional<Evaluation> evaluate(const pipeline::Compiled& spec, const Request& request,
                                   const std::optional<thresholds::File>& seen, diag::Sink& sink);

/// For people: an aligned table. For spreadsheets: a figure a row. For programs: JSON.
std::string table(const Evaluation& evaluation);
std::string csv(const Evaluation& evaluation);
std::string json(const Evaluation& evaluation);

}  // namespace etlc::evaluate
