#include "episodes/replay.hpp"

#include <algorithm>
#include <set>

namespace etlc::episodes {

Follower::Follower(const plan::Plan& plan, const GroundTruth* truth)
    : plan_(plan), truth_(truth), places_(plan.model->monitors.size()), evaluator_(plan) {
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) places_[plan.monitors[m].index] = m;
    if (truth != nullptr) labelled_ = labelled_predicates(*truth);
}

void Follower::step(const Frames& recording) {
    finished_ = false;
    if (truth_ == nullptr) {
        verdicts_ = &evaluator_.step(recording.samples());
        return;
    }
    samples_.assign(recording.samples().begin(), recording.samples().end());
    samples_.resize(truth_->model.inputs.size());
    for (const Index predicate : labelled_)
        samples_[truth_->inputs[predicate]] = sample_of(recording.label(predicate));
    verdicts_ = &evaluator_.step(samples_);
}

void Follower::finish() {
    finished_ = true;
    verdicts_ = &evaluator_.finish();
}

bool Follower::reports(Index monitor) const {
    return verdict(monitor).decided() && (!finished_ || plan_.model->monitors[monitor].sliding);
}

Wanted wanted(const check::Model& model, const std::vector<const plan::Plan*>& plans,
              std::vector<Index> predicates, const Leaks& leaks) {
    std::vector<Index> identity = identity_inputs(model);
    std::set<Index> inputs(identity.begin(), identity.end());
    for (const plan::Plan* plan : plans)
        for (const Index input : plan->inputs)
            if (input < model.inputs.size()) inputs.insert(input);  // the others are labels
    return {
        &model, {inputs.begin(), inputs.end()}, std::move(predicates), std::move(identity), &leaks};
}

diag::Result<bool> replay(Frames& recording, const std::vector<Follower*>& followers,
                          const AfterStep& frame, const AfterStep& rest) {
    for (Follower* follower : followers) follower->reset();
    for (;;) {
        const auto more = recording.next();
        if (!more) return more.failure();
        if (!*more) break;
        for (Follower* follower : followers) follower->step(recording);
        if (!frame()) return false;
    }
    std::uint32_t left = 0;
    for (const Follower* follower : followers)
        for (const plan::Monitor& monitor : follower->plan().monitors)
            left = std::max(left, monitor.horizon);
    for (std::uint32_t position = 0; rest && position < left; ++position) {
        for (Follower* follower : followers) follower->finish();
        if (!rest()) return false;
    }
    return true;
}

}  // namespace etlc::episodes
