// Replays recorded episodes against monitors with other thresholds, without reading them again. A
// track holds what the formulas see of each step, so no distance is measured twice: 4 bytes for
// each predicate, and one for each label and boolean input.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/guarantees/guarantees.hpp"
#include "episodes/replay.hpp"
#include "episodes/truth.hpp"
#include "pipeline/compile.hpp"

namespace etlc::calibrate {

using check::Index;

/// A monitor with a guarantee, for its whole formula or for a conjunct.
struct Guaranteed {
    Index monitor = 0;
    check::Claim claim;  ///< missed_success or missed_alarm
};

/// The parts of a step that a track holds.
struct Watched {
    std::vector<Index> predicates;  ///< what they measure
    std::vector<Index> labelled;    ///< their labels; the other predicates are their own truth
    std::vector<Index> flags;       ///< boolean inputs
};

/// Returns what the formulas of these guarantees see. `labelled`: predicates with labels.
Watched watched_by(const check::Model& model, const std::vector<Guaranteed>& all,
                   const std::vector<Index>& labelled);

/// Appends a step to the track.
void add_step(const Watched& watched, const plan::Evaluator& measured,
              const episodes::Frames& recording, std::string& track);

/// The verdicts of a monitor and of its truth over the steps of an episode whose truth is known.
struct Said {
    std::uint64_t steps = 0;
    std::uint64_t satisfied = 0;  ///< according to the monitor
    std::uint64_t violated = 0;
    std::uint64_t truly_satisfied = 0;
    std::uint64_t falsely_satisfied = 0;
    std::uint64_t falsely_violated = 0;
};

/// The thresholds of an episode.
struct Thresholds {
    std::vector<float> predicates;  ///< by index in the model
    std::vector<float> shifts;      ///< per guarantee; read for monitors calibrated as a whole
};

/// Replays one episode after the other, on one thread.
class Replayer {
public:
    /// Returns nothing where the monitors exceed the limits of a plan. `model` has all thresholds
    /// and outlives the replayer.
    static std::unique_ptr<Replayer> make(const check::Model& model, std::vector<Guaranteed> all,
                                          Watched watched);
    Replayer(const Replayer&) = delete;
    Replayer& operator=(const Replayer&) = delete;

    /// Returns the verdicts per guarantee.
    std::vector<Said> replay(const std::string& track, const Thresholds& thresholds);

private:
    class Steps;

    Replayer(const check::Model& model, std::vector<Guaranteed> all, Watched watched,
             pipeline::Compiled monitors, episodes::GroundTruth truth, pipeline::Compiled truths);

    void note(std::vector<Said>& said);

    const check::Model& model_;
    std::vector<Guaranteed> all_;
    Watched watched_;
    pipeline::Compiled monitor_plan_;
    episodes::GroundTruth truth_;
    pipeline::Compiled truth_plan_;
    episodes::Follower monitors_;
    episodes::Follower truths_;
    std::vector<float> measured_;  ///< of this step, by index of the model's predicates
    const Thresholds* thresholds_ = nullptr;
};

}  // namespace etlc::calibrate
