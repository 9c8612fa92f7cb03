// One episode: what the monitors said of it, beside what was true.
// Takes: the plans of the spec and of its ground truth, and an episode. Gives: counts per predicate
// and monitor, the distances for ranking, and when verdicts turned. Keeps true: both monitors are
// run by the same evaluator, and what the spec's is given is what the generated class would be
// given.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/episodes/admission.hpp"
#include "calibrate/episodes/leaks.hpp"
#include "calibrate/episodes/recording.hpp"
#include "data/traces/trace.hpp"
#include "evaluate/counts.hpp"
#include "evaluate/ranking.hpp"
#include "evaluate/subject.hpp"
#include "plan/evaluate/evaluator.hpp"

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
};

struct EpisodeResult : calibrate::Recorded {
    std::vector<Counts> predicates;           ///< per labelled predicate
    std::vector<std::vector<Scored>> scored;  ///< per labelled predicate; `episode` is not yet set
    /// Per labelled predicate: labelled frames whose distance is unknown.
    std::vector<std::uint64_t> unmeasured;
    std::vector<bool> from_array;  ///< per labelled predicate
    /// Per monitor; of those that cannot be evaluated all is zero.
    std::vector<MonitorEpisode> monitors;
};

/// Judges one episode after the other. Not shared between threads; all that it is given outlives
/// it.
class Judge {
public:
    Judge(const plan::Plan& plan, const plan::Plan& truth, const Subject& subject,
          const calibrate::Leaks& leaks, const data::NamesInFile& names);
    Judge(const Judge&) = delete;
    Judge& operator=(const Judge&) = delete;

    /// Failures do not name the path.
    diag::Result<EpisodeResult> score(const std::string& path);

private:
    using Track = std::vector<Label>;

    struct Tracks {
        Track said;
        Track is;
    };

    void step(const calibrate::Recording& recording, EpisodeResult& result);
    void count_predicates(const calibrate::Recording& recording, EpisodeResult& result) const;
    void note(const std::vector<etlmon::Verdict>& said, const std::vector<etlmon::Verdict>& is);
    void finish();
    float distance(Index predicate) const;
    MonitorEpisode conclude(const MonitorSubject& subject, const Tracks& tracks) const;
    const check::Model& model() const { return *plan_.model; }

    const plan::Plan& plan_;
    const plan::Plan& truth_plan_;
    const Subject& subject_;
    const calibrate::Leaks& leaks_;
    const data::NamesInFile& names_;
    std::vector<std::size_t> said_at_;  ///< per monitor, its index in plan_
    /// Per monitor of the ground truth, its index in truth_plan_.
    std::vector<std::size_t> truth_at_;
    plan::Plan measuring_;  ///< of labelled predicates that no monitor uses
    plan::Evaluator monitor_;
    plan::Evaluator truth_;
    plan::Evaluator measure_;
    calibrate::Wanted wanted_;
    std::vector<plan::Sample> truth_samples_;
    std::vector<Tracks> tracks_;  ///< per monitor
    std::vector<bool> visited_;   ///< per monitor of the ground truth: satisfied at the last step
};

}  // namespace etlc::evaluate
