// Compares the monitors with their ground truth on one episode: counts per predicate and monitor,
// distances for ranking, and the time at which verdicts turned. The same evaluator runs both, on
// the samples that the generated class would get.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/recording.hpp"
#include "episodes/truth.hpp"
#include "episodes/variants/variants.hpp"
#include "evaluate/figures.hpp"

namespace etlc::evaluate {

// ---- what is evaluated --------------------------------------------------------------------------
// Selects the monitors of a spec that can be evaluated, and builds the ground-truth model, in which
// every predicate is replaced by its truth. A predicate over scalars with a literal threshold is
// its own truth; a monitor with any other predicate without labels is left out.

using check::Index;

/// Returns the conjuncts of each of a, b, ... in F (a && F (b && ...)); one such list for F a, and
/// none for any other formula.
std::vector<std::vector<Index>> stages_of(const check::Model& model, Index formula);

struct MonitorSubject {
    Index monitor = 0;           ///< in the model
    std::vector<Index> lacking;  ///< predicates without a truth; empty: it can be evaluated
    Index truth = check::kNone;  ///< monitor in the ground-truth model
    /// For F (a && F (b && ...)) the monitors F a, F b, ... of the ground-truth model; else empty.
    std::vector<Index> stages;
};

struct Subject {
    std::vector<Index> labelled;  ///< predicates
    std::vector<Index> lets;      ///< with a truth over these; check::Options::judged_lets
    episodes::GroundTruth truth;
    std::vector<MonitorSubject> monitors;
};

/// `labelled` lists the predicates with a truth in the spec or in every episode.
Subject subject(const check::Model& model, std::vector<Index> labelled);

/// Returns whether there is a label or a monitor that is its own truth.
bool has_truths(const Subject& subject);

// ---- episode by episode -------------------------------------------------------------------------

/// A change of the true verdict from that of the first step, and the monitor's reaction.
struct Turn {
    /// Steps from the true turn to the monitor's; negative where the monitor turned earlier and
    /// kept its verdict. Nothing where it never turned.
    std::optional<std::int64_t> delay;
};

struct MonitorEpisode {
    Counts steps;    ///< for a sliding monitor: all positions
    Counts episode;  ///< one prediction: the last verdict, or that a sliding monitor always holds
    std::optional<Turn> turn;
    std::optional<Counts>
        ordering;     ///< one prediction: sequential formulas, all stages truly visited
    LabelRuns truth;  ///< true labels of the steps
    /// The first step (sliding monitors: position) at which the prediction is wrong.
    std::optional<std::uint64_t> first_error;
    /// Per requested kind, the verdicts on variants of the episode, as in `episode`.
    std::vector<Counts> variants;
    std::optional<std::uint64_t> alarm;  ///< the step of the first alarm, whatever the truth
    float least_upper = std::numeric_limits<float>::infinity();  ///< of all verdicts
};

struct PredicateEpisode {
    Counts frames;
    std::vector<episodes::Scored> scored;  ///< their member `episode` is not yet set
    std::uint64_t unmeasured = 0;          ///< labelled frames whose distance is unknown
    bool from_array = false;
    LabelRuns truth;  ///< true labels of the frames
    std::optional<std::uint64_t> first_error;
};

struct EpisodeResult : episodes::Recorded {
    std::vector<PredicateEpisode> predicates;  ///< per labelled predicate, then per judged let
    /// Per monitor; only alarms and bounds for those that cannot be evaluated.
    std::vector<MonitorEpisode> monitors;
    std::vector<std::uint64_t> variants;  ///< per requested kind, their number
};

template <class Archive>
void fields(Archive& archive, Turn& turn) {
    archive(turn.delay);
}

template <class Archive>
void fields(Archive& archive, MonitorEpisode& monitor) {
    archive(monitor.steps, monitor.episode, monitor.turn, monitor.ordering, monitor.truth,
            monitor.first_error, monitor.variants, monitor.alarm, monitor.least_upper);
}

template <class Archive>
void fields(Archive& archive, PredicateEpisode& predicate) {
    archive(predicate.frames, predicate.scored, predicate.unmeasured, predicate.from_array,
            predicate.truth, predicate.first_error);
}

template <class Archive>
void fields(Archive& archive, EpisodeResult& result) {
    archive(static_cast<episodes::Recorded&>(result), result.predicates, result.monitors,
            result.variants);
}

}  // namespace etlc::evaluate
