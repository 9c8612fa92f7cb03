// One episode: what the monitors said of it, and what was true.
// Takes: the plans of the spec and of its ground truth, and an episode. Gives: counts per predicate
// and monitor, the distances for ranking, and when verdicts turned. Keeps true: both monitors are
// run by the same evaluator, on the samples that the generated class would get.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "episodes/ranking/auroc.hpp"
#include "episodes/replay.hpp"
#include "evaluate/counts.hpp"
#include "evaluate/duration.hpp"
#include "evaluate/subject.hpp"

namespace etlc::evaluate {

/// The first step at which the true verdict is another than at the first step, and when the monitor
/// said so.
struct Turn {
    /// Steps from the true turn to the monitor's: negative where it said so before and has held on
    /// to it since. Nothing: it never did.
    std::optional<std::int64_t> delay;
};

struct MonitorEpisode {
    Counts steps;    ///< of a sliding monitor: positions, all of them
    Counts episode;  ///< one: the last verdict; of a sliding monitor, whether every position
                     ///< satisfies it
    std::optional<Turn> turn;
    /// One: of sequential formulas, where every stage was truly visited.
    std::optional<Counts> ordering;
    LabelRuns truth;  ///< what was true of the steps
    /// The step, or the position of a sliding monitor, at which it first disagrees with a known
    /// truth.
    std::optional<std::uint64_t> first_error;
};

struct PredicateEpisode {
    Counts frames;
    std::vector<episodes::Scored> scored;  ///< `episode` is not yet set
    std::uint64_t unmeasured = 0;          ///< labelled frames whose distance is unknown
    bool from_array = false;
    LabelRuns truth;  ///< of the frames
    std::optional<std::uint64_t> first_error;
};

struct EpisodeResult : episodes::Recorded {
    std::vector<PredicateEpisode> predicates;  ///< per labelled predicate
    /// Per monitor; of those that cannot be evaluated all is zero.
    std::vector<MonitorEpisode> monitors;
};

template <class Archive>
void fields(Archive& archive, Turn& turn) {
    archive(turn.delay);
}

template <class Archive>
void fields(Archive& archive, MonitorEpisode& monitor) {
    archive(monitor.steps, monitor.episode, monitor.turn, monitor.ordering, monitor.truth,
            monitor.first_error);
}

template <class Archive>
void fields(Archive& archive, PredicateEpisode& predicate) {
    archive(predicate.frames, predicate.scored, predicate.unmeasured, predicate.from_array,
            predicate.truth, predicate.first_error);
}

template <class Archive>
void fields(Archive& archive, EpisodeResult& result) {
    archive(static_cast<episodes::Recorded&>(result), result.predicates, result.monitors);
}

/// Scores one episode after the other. Not shared between threads; all that it is given outlives
/// it.
class EpisodeScorer {
public:
    EpisodeScorer(const plan::Plan& plan, const plan::Plan& truth, const Subject& subject,
                  const episodes::Leaks& leaks, const data::NamesInFile& names);
    EpisodeScorer(const EpisodeScorer&) = delete;
    EpisodeScorer& operator=(const EpisodeScorer&) = delete;

    /// Failures do not name the path.
    diag::Result<EpisodeResult> score(const std::string& path);

private:
    using Track = std::vector<Label>;

    struct Tracks {
        Track said;
        Track is;
        bool said_alarm = false;  ///< at some step
        bool is_alarm = false;
    };

    void note_frame(const episodes::Recording& recording, std::size_t i,
                    PredicateEpisode& result) const;
    void note_verdicts();
    void follow(std::size_t m);
    float distance(Index predicate) const;
    MonitorEpisode conclude(const MonitorSubject& subject, const Tracks& tracks) const;
    const check::Model& model() const { return *plan_.model; }

    const plan::Plan& plan_;
    const Subject& subject_;
    const data::NamesInFile& names_;
    plan::Plan measuring_;  ///< of labelled predicates that no monitor uses
    episodes::Follower monitors_;
    episodes::Follower truths_;
    episodes::Follower measured_;
    episodes::Wanted wanted_;
    std::vector<Tracks> tracks_;  ///< per monitor
};

}  // namespace etlc::evaluate
