// `etlc evaluate`: compares the monitors of a spec with ground truth on recorded episodes. Computes
// counts and rates per predicate and monitor, with intervals and baselines; the same per episode;
// and the differences between specs on the same episodes. The result does not depend on the number
// of threads, each thread has one episode open at a time, and episodes of the calibration are
// refused.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "artifacts/fitted.hpp"
#include "artifacts/thresholds.hpp"
#include "compile.hpp"
#include "data/spill/spill.hpp"
#include "diag/diag.hpp"
#include "episodes/folds.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/shared/sharing.hpp"
#include "evaluate/episode_scores.hpp"
#include "evaluate/outcomes.hpp"

namespace etlc::evaluate {

/// A compiled spec and the episodes that it is judged on; one trial per fold.
struct Trial {
    const Compiled& spec;
    std::optional<thresholds::File>
        seen;                           ///< its calibrated thresholds, whose episodes are refused
    std::vector<std::size_t> episodes;  ///< indices into the request's episodes
    fitted::File fitted{};              ///< its fitted entries, whose episodes are refused
};

struct Request {
    std::vector<std::string> episodes;  ///< as recordings::find_episodes gives them
    episodes::ReadOptions reading;
    std::string allow_overlap;  ///< reason to allow overlaps with calibration; empty: refuse them
    unsigned jobs = 0;          ///< threads; 0: as many as the machine has
    plan::Limits limits;        ///< limits on the ground truth's plan
    std::vector<episodes::Variant> variants;  ///< failures to make of the episodes
    std::uint64_t only_trained = 0;           ///< episodes before these, of folds in order
    /// Called occasionally, by any thread, never by two at once.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// One shard of the episodes, or all shards; null: this process reads all episodes.
    episodes::Sharing* sharing = nullptr;
};

/// Scores the episodes of a trial: compares the monitors of `subject` with their ground truth.
/// `take(i, result)` gets that of its i-th episode, in order. Returns false after an error, which
/// it reports, and for a shard.
bool score_episodes(const Trial& trial, const Subject& subject, const Request& request,
                    const std::function<void(std::size_t, EpisodeResult)>& take, diag::Sink& sink);

/// The variants of one kind.
struct VariantsMade {
    episodes::Variant variant = episodes::Variant::cut;
    std::uint64_t made = 0;
    std::uint64_t left_out = 0;  ///< episodes that are too short for one
};

/// The conditions under which episodes were judged.
struct Conditions {
    struct Fold {
        std::uint64_t episodes = 0;                             ///< held out
        std::vector<std::pair<std::string, float>> thresholds;  ///< from the others, by name
    };
    std::vector<Fold> folds;                ///< empty without folds
    std::uint64_t only_trained = 0;         ///< as in the request
    double step_seconds = 0;                ///< 0: the spec has no rate
    std::vector<std::string> reservations;  ///< allowances that were used, in words
    std::vector<VariantsMade> variants;     ///< per requested kind
};

/// Predictions and truths of all episodes, most of them in temporary files.
struct Judgement : Conditions {
    struct Predicate {
        std::string name;
        bool adaptive = false;
        data::Spool<PredicateEpisode> episodes{};       ///< without their frames
        std::vector<episodes::FramesByScore> frames{};  ///< one per fold, or one for all episodes
    };
    struct Monitor {
        std::string name;
        std::vector<std::string> lacking;  ///< predicates without truth
        bool sequential = false;
        data::Spool<MonitorEpisode> episodes{};
    };
    std::vector<Predicate> predicates;  ///< those with labels, then the lets with a truth
    std::vector<Monitor> monitors;
    episodes::Identities episodes;       ///< ordered by fold, as those of predicates, monitors
    episodes::Groups groups;             ///< of the episodes of the request
    std::vector<std::uint32_t> place;    ///< index in that order, per episode of the request
    std::vector<std::uint32_t> fold_of;  ///< per episode of the request

    /// Calls `visit(e, item)` for the item of each episode, in the order of the request.
    template <class T, class Visit>
    void for_each(const data::Spool<T>& of, const Visit& visit) const {
        for (std::size_t e = 0; e < place.size(); ++e) visit(e, of[place[e]]);
    }
    /// Returns `get(item)` for each, in the same order.
    template <class T, class Get>
    auto each(const data::Spool<T>& of, const Get& get) const {
        std::vector<std::decay_t<decltype(get(std::declval<const T&>()))>> all;
        all.reserve(place.size());
        for_each(of, [&](std::size_t, const T& item) { all.push_back(get(item)); });
        return all;
    }
};

/// Shares of the episodes with a case in which none is called wrong, for which calibration
/// guarantees P >= 1 - alpha.
struct Coverage {
    Figure of_positives;
    Figure of_negatives;
};

/// Counts of predictions, with intervals over episodes.
struct Score : ByRate<Figure> {
    Counts counts;
    Figure gain;                     ///< F1 less the F1 of always predicting true
    std::optional<Counts> duration;  ///< the duration baseline (evaluate/figures.hpp)
    bool of_variants = false;        ///< whose length follows from their kind: no such baseline
};

/// Returns the rates of predictions that ignore the data: "always_true", "always_false",
/// "duration".
std::vector<std::pair<std::string, Rates>> baselines(const Score& score);

struct PredicateScore {
    std::string name;
    bool adaptive = false;  ///< evaluated with its initial threshold, as there is no feedback here
    Score frames;
    Figure auroc;  ///< of the distance, or of a let's robustness
    Coverage coverage;
    std::uint64_t unmeasured = 0;  ///< labelled frames of unknown distance, counted as misses
    std::uint64_t arrays = 0;      ///< episodes with an array of labels
};

/// Time from a change of the true verdict to the monitor's.
struct Detection {
    std::uint64_t turns = 0;  ///< episodes in which the true verdict changed
    std::uint64_t missed = 0;
    std::uint64_t early = 0;  ///< the monitor changed first
    Figure mean;              ///< steps, over the turns that were not missed
    std::optional<double> median;
};

struct MonitorScore {
    std::string name;
    std::vector<std::string> lacking;  ///< predicates without truth; then only outcomes are set
    std::optional<OutcomeScore> outcomes;
    Score steps;
    Coverage coverage;
    Score episodes;
    Detection detection;
    std::optional<Score> ordering;  ///< sequential formulas: episodes with all stages truly visited
    std::vector<Score> variants;    ///< per requested kind, then of all; empty without variants
};

struct EpisodeRow {
    /// The first step at which a predicate, or else a monitor, is called wrong.
    struct Error {
        std::uint64_t step = 0;  ///< for a sliding monitor the position
        std::string name;
        bool of_monitor = false;
    };
    std::string path;
    std::optional<std::uint32_t> fold;  ///< from 1, if there are folds
    std::uint64_t frames = 0;
    episodes::Outcome::Kind outcome = episodes::Outcome::Kind::none;
    std::vector<std::string> wrong;  ///< monitors with a wrong verdict on the episode
    std::vector<std::pair<std::string, std::uint64_t>> alarms;  ///< step of the first, by monitor
    Counts predictions;  ///< frames of all labelled predicates; without any, steps of all monitors
    std::optional<Error> first_error;
    std::vector<std::pair<std::string, Counts>> predicates;  ///< by frames
};

struct Evaluation : Conditions {
    std::uint64_t episodes = 0;
    std::optional<std::uint64_t> groups;  ///< nothing where no episode has one
    std::uint64_t frames = 0;
    std::uint64_t repeated = 0;     ///< episodes that repeat an earlier one
    std::uint64_t leaked = 0;       ///< episodes with a frame that is a row of a target
    std::uint64_t overlapping = 0;  ///< episodes that share most of their content with another
    std::vector<PredicateScore> predicates;
    std::vector<MonitorScore> monitors;
    std::vector<EpisodeRow> by_episode;  ///< empty unless requested
};

/// Runs the monitors on all episodes. Labels come from the spec's truths, or from the arrays that
/// the first episode has. The trials are of one spec and hold each episode once. Returns nothing
/// after an error, which it reports.
std::optional<Judgement> judge(const std::vector<Trial>& trials, const Request& request,
                               diag::Sink& sink);

/// `jobs`: threads; 0: one per core. The result does not depend on it.
Evaluation summarise(const Judgement& judgement, unsigned jobs);

/// A figure of each resample of the episodes.
using Statistic = std::function<std::vector<std::optional<double>>(const Weights&)>;

/// Counts of a predicate or monitor in each episode, in the order of the request.
struct EpisodeCounts {
    std::vector<Counts> own;
    std::vector<Counts> on_variants;  ///< on broken variants of each; empty: not judged
};
/// Frames of a predicate or let.
EpisodeCounts counts_by_frames(const Judgement& judgement, std::size_t predicate);
/// A monitor's steps or verdicts, and its verdicts on broken variants.
EpisodeCounts counts_by_truth(const Judgement& judgement, std::size_t monitor,
                              Counts MonitorEpisode::*of_episode);
/// A prediction for each episode: an alarm says that it failed. Where no episode has an outcome,
/// all are taken for successes.
EpisodeCounts counts_by_outcome(const Judgement& judgement, std::size_t monitor);
/// The mean of a rate on the episodes and on their variants; of that which is defined.
Statistic statistic(const EpisodeCounts& counts, Rate rate);
/// Returns the second less the first, over the same resamples.
Figure less(const Bootstrap& bootstrap, const Statistic& second, const Statistic& first);
/// Returns the F1 by frames of the duration baseline.
std::optional<double> f1_of_duration(const Judgement& judgement, std::size_t predicate);

/// Returns a row per episode, worst first, since figures over all episodes hide a session on which
/// a monitor fails. An episode is worse with more wrong verdicts of monitors; ties go to the
/// greater share of wrong frames, then to the earlier episode.
std::vector<EpisodeRow> by_episode(const Judgement& judgement);

/// Warns about labels that are all alike or inverted, and about predicates that are no better than
/// always predicting true.
void warn_of_doubts(const check::Model& model, const Evaluation& evaluation, diag::Sink& sink);

/// Figures of a predicate or monitor: the second spec's less the first's.
struct Difference : ByRate<Figure> {
    bool of_monitor = false;
    std::string name;
    std::string level;               ///< frames, steps, episodes
    std::uint64_t other_truths = 0;  ///< episodes whose truth differs; if any, no figures
    std::optional<Figure> auroc;     ///< predicates only
};

/// Compares two specs on the same episodes, for each predicate and monitor that both have by name.
/// Intervals are those of the differences over common resamples, since an episode that is hard for
/// one spec is mostly hard for the other.
std::vector<Difference> differences(const Judgement& first, const Judgement& second);

/// Specs on the same episodes.
struct SideBySide {
    struct Spec {
        std::string path;
        Evaluation evaluation;
        std::vector<Difference> differences;  ///< to the first spec
    };
    std::vector<Spec> specs;
};

/// Format evaluations as aligned tables for people, as CSV with a row per figure or episode for
/// spreadsheets, and as JSON for programs. A single spec is not named.
std::string table(const SideBySide& specs);
std::string csv(const SideBySide& specs);
std::string csv_by_episode(const SideBySide& specs);
std::string json(const SideBySide& specs);

}  // namespace etlc::evaluate
