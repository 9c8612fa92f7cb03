// `etlc evaluate`: the monitors of a spec against ground truth, on recorded episodes.
// Takes: the compiled spec, or one for every fold, and the episodes. Gives: counts and rates per
// predicate and monitor, each with its interval and next to the baselines that ignore the data;
// the same of every episode; and how much specs differ on the same episodes. Keeps true: the
// result is the same whatever the number of threads; one episode a thread is open at a time;
// episodes that thresholds were calibrated on are refused.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "data/spill/spool.hpp"
#include "diag/diag.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/shared/sharing.hpp"
#include "evaluate/bootstrap.hpp"
#include "evaluate/by_episode.hpp"
#include "evaluate/differences.hpp"
#include "evaluate/episode_scores.hpp"
#include "evaluate/subject.hpp"
#include "fitted/fitted.hpp"
#include "pipeline/compile.hpp"
#include "thresholds/thresholds.hpp"

namespace etlc::evaluate {

/// A compiled spec and the episodes that it is judged on. Several where episodes are dealt into
/// folds.
struct Trial {
    const pipeline::Compiled& spec;
    /// The thresholds that its plan has, where they were calibrated: episodes in it are refused.
    std::optional<thresholds::File> seen;
    std::vector<std::size_t> episodes;  ///< which of those of the request
    fitted::File fitted{};              ///< what is fitted in its model: episodes in it are refused
};

struct Request {
    std::vector<std::string> episodes;  ///< as data::find_episodes gives them
    data::NamesInFile names;
    std::string allow_overlap;  ///< the reason for which overlaps with the episodes of calibration
                                ///< are passed over; empty: they are not
    unsigned jobs = 0;          ///< threads; 0: as many as the machine has
    plan::Limits limits;        ///< of the ground truth's plan
    /// Called now and then, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// One shard of the episodes, or all of them; null: this process reads them all.
    episodes::Sharing* sharing = nullptr;
};

/// What a spec said of the episodes, and what was true. Little of it is in memory, however many
/// there are.
struct Judgement {
    struct Predicate {
        std::string name;
        bool adaptive = false;
        data::Spool<PredicateEpisode> episodes{};       ///< without their frames
        std::vector<episodes::FramesByScore> frames{};  ///< of each fold; of one, where none are
    };
    struct Monitor {
        std::string name;
        std::vector<std::string> lacking;  ///< predicates without truth
        bool sequential = false;
        data::Spool<MonitorEpisode> episodes{};
    };
    /// What was held out, and the thresholds of the rest by what they are of; of one fold nothing.
    struct Fold {
        std::uint64_t episodes = 0;
        std::vector<std::pair<std::string, float>> thresholds;
    };
    std::vector<Predicate> predicates;  ///< those with labels
    std::vector<Monitor> monitors;
    episodes::Identities episodes;          ///< this, and those of predicates and monitors, by fold
    std::vector<std::uint32_t> place;       ///< in them, per episode of the request
    std::vector<std::uint32_t> fold_of;     ///< per episode of the request
    std::vector<Fold> folds;                ///< empty: no spec was made for a fold
    double step_seconds = 0;                ///< 0: the spec has no rate
    std::vector<std::string> reservations;  ///< what was passed over, in words

    /// Calls `visit(e, item)` for the item of each episode, in the order of the request.
    template <class T, class Visit>
    void for_each(const data::Spool<T>& of, const Visit& visit) const {
        for (std::size_t e = 0; e < place.size(); ++e) visit(e, of[place[e]]);
    }
    /// `get(item)` of each.
    template <class T, class Get>
    auto each(const data::Spool<T>& of, const Get& get) const {
        std::vector<std::decay_t<decltype(get(std::declval<const T&>()))>> all;
        all.reserve(place.size());
        for_each(of, [&](std::size_t, const T& item) { all.push_back(get(item)); });
        return all;
    }
};

/// Counts of claims, with intervals over episodes.
struct Score {
    Counts counts;
    Figure f1;
    Figure precision;
    Figure recall;
    Figure agreement;
    Figure gain;                     ///< of F1 over that of saying true every time
    std::optional<Counts> duration;  ///< what the duration alone gets right: evaluate/duration.hpp
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
    std::vector<Judgement::Fold> folds;
    std::vector<PredicateScore> predicates;
    std::vector<MonitorScore> monitors;
    std::vector<EpisodeRow> by_episode;  ///< empty: not asked for
};

/// Predicates are held to the truth that the spec has, or an array in the first episode. Trials are
/// of one spec and hold each episode once. Nothing where the sink now says why.
std::optional<Judgement> judge(const std::vector<Trial>& trials, const Request& request,
                               diag::Sink& sink);

Evaluation summarise(const Judgement& judgement);

/// Warns of labels that are all alike or the wrong way round, and of predicates that are no better
/// than saying true every time. `model`: of the spec.
void warn_of_doubts(const check::Model& model, const Evaluation& evaluation, diag::Sink& sink);

/// Specs on the same episodes.
struct SideBySide {
    struct Spec {
        std::string path;
        Evaluation evaluation;
        std::vector<Difference> differences;  ///< from the first spec
    };
    std::vector<Spec> specs;
};

/// For people: aligned tables. For spreadsheets: a figure a row, or an episode. For programs: JSON.
/// Of one spec the same as of its evaluation, without its path.
std::string table(const SideBySide& specs);
std::string csv(const SideBySide& specs);
std::string csv_by_episode(const SideBySide& specs);
std::string json(const SideBySide& specs);

}  // namespace etlc::evaluate
