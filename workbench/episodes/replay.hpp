// A recorded episode, run through monitors a step at a time.
// Takes: an opened recording, and plans to run side by side, of a spec or of its ground truth.
// Gives: a call after every step, when the verdicts and distances of all of them are there. Keeps
// true: every plan gets the samples that its generated class would get; after the last frame
// sliding monitors report the positions that are left.
#pragma once

#include <functional>
#include <vector>

#include "episodes/recording.hpp"
#include "episodes/truth.hpp"
#include "plan/evaluate/evaluator.hpp"

namespace etlc::episodes {

/// A plan that is stepped through episodes. All that it is given outlives it.
class Follower {
public:
    /// `truth`: of a plan of the ground truth, whose inputs the labels are.
    explicit Follower(const plan::Plan& plan, const GroundTruth* truth = nullptr);

    plan::Evaluator& evaluator() { return evaluator_; }
    const plan::Evaluator& evaluator() const { return evaluator_; }
    const plan::Plan& plan() const { return plan_; }

    /// Of the last step, by index of the plan's monitors.
    const std::vector<etlmon::Verdict>& verdicts() const { return *verdicts_; }
    /// Of the last step, by index of the model's monitors.
    const etlmon::Verdict& verdict(Index monitor) const { return verdicts()[places_[monitor]]; }
    /// Whether that verdict is about a position that had none: after the last frame, a prefix
    /// monitor only repeats its last one.
    bool reports(Index monitor) const;

    void reset() { evaluator_.reset(); }
    /// From the next step on, this monitor of the model is about that step.
    void restart(Index monitor) { evaluator_.restart(places_[monitor]); }
    void step(const Frames& recording);
    /// After the last frame.
    void finish();

private:
    const plan::Plan& plan_;
    const GroundTruth* truth_;
    std::vector<Index> labelled_;      ///< predicates that have a label in the ground truth
    std::vector<std::size_t> places_;  ///< per monitor of the model, its index in the plan
    plan::Evaluator evaluator_;
    std::vector<plan::Sample> samples_;  ///< with the labels
    const std::vector<etlmon::Verdict>* verdicts_ = nullptr;
    bool finished_ = false;
};

/// What has to be read of an episode for these plans of the model or of its ground truth: the
/// inputs that they read, those that tell episodes apart, and the labels of `predicates`.
Wanted wanted(const check::Model& model, const std::vector<const plan::Plan*>& plans,
              std::vector<Index> predicates, const Leaks& leaks);

/// Called after a step of all followers. False: no further one.
using AfterStep = std::function<bool()>;

/// From the first frame of the recording to its last, with `frame` after each; then, where there is
/// a `rest`, through the positions that the end leaves open, with `rest` after each. Gives: whether
/// it came to the end.
diag::Result<bool> replay(Frames& recording, const std::vector<Follower*>& followers,
                          const AfterStep& frame, const AfterStep& rest = nullptr);

}  // namespace etlc::episodes
