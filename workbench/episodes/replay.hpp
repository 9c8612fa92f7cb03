// Runs a recorded episode through monitors, of a spec or of its ground truth, step by step. Every
// plan gets the samples that its generated class would get; after the last frame sliding monitors
// report the remaining positions.
#pragma once

#include <functional>
#include <vector>

#include "episodes/recording.hpp"
#include "episodes/truth.hpp"
#include "execute/evaluator.hpp"

namespace etlc::episodes {

/// Steps a plan through episodes. The arguments outlive it.
class Follower {
public:
    /// `truth`: set for a plan of the ground truth, whose inputs include the labels.
    explicit Follower(const plan::Plan& plan, const GroundTruth* truth = nullptr);

    execute::Evaluator& evaluator() { return evaluator_; }
    const execute::Evaluator& evaluator() const { return evaluator_; }
    const plan::Plan& plan() const { return plan_; }

    /// Returns the verdicts of the last step, by index of the plan's monitors.
    const std::vector<etlmon::Verdict>& verdicts() const { return *verdicts_; }
    /// Returns the verdict of the last step, by index of the model's monitors.
    const etlmon::Verdict& verdict(Index monitor) const { return verdicts()[places_[monitor]]; }
    /// Returns whether that verdict is decided and new: after the last frame, a prefix monitor
    /// repeats its last one.
    bool reports(Index monitor) const;

    void reset() { evaluator_.reset(); }
    /// Restarts a monitor of the model with the next step.
    void restart(Index monitor) { evaluator_.restart(places_[monitor]); }
    void step(const Frames& recording);
    /// Reports the next position after the last frame.
    void finish();

private:
    const plan::Plan& plan_;
    const GroundTruth* truth_;
    std::vector<Index> labelled_;      ///< predicates with labels in the ground truth
    std::vector<std::size_t> places_;  ///< per monitor of the model, its index in the plan
    execute::Evaluator evaluator_;
    std::vector<execute::Sample> samples_;  ///< samples with the labels
    const std::vector<etlmon::Verdict>* verdicts_ = nullptr;
    bool finished_ = false;
};

/// Returns what to read of an episode for these plans of the model or of its ground truth: their
/// inputs, those of the hash, and the labels of `predicates`.
Wanted wanted(const check::Model& model, const std::vector<const plan::Plan*>& plans,
              std::vector<Index> predicates, const Leaks& leaks);

/// Called after each step of all followers; returns false to stop.
using AfterStep = std::function<bool()>;

/// Steps followers through all frames, with `frame` after each; then, if given `rest`, through the
/// positions that the end leaves open, with `rest` after each. Returns whether it reached the end.
diag::Result<bool> replay(Frames& recording, const std::vector<Follower*>& followers,
                          const AfterStep& frame, const AfterStep& rest = nullptr);

}  // namespace etlc::episodes
