#include "monitoring.hpp"

#include <utility>

#include "dubins.hpp"  // generated from dubins.etl
#include "targets.hpp"

namespace demo {

const std::array<float, 3> kThresholds{dubins::Monitor::threshold_at_a(),
                                       dubins::Monitor::threshold_at_b(),
                                       dubins::Monitor::threshold_near_c()};

namespace {

Claim claim(const etlmon::Verdict& verdict) {
    return {verdict.satisfied(), verdict.final(), verdict.robustness};
}

/// The four formulas of dubins.etl over the truth, written by hand.
class Truth {
public:
    std::array<bool, kMonitors.size()> step(const std::array<bool, kPredicates.size()>& now) {
        const auto [at_a, at_b, near_c] = now;
        reached_ |= at_a;
        avoided_ &= !near_c;
        in_order_ |= reached_ && at_b;
        return {reached_, avoided_, reached_ && avoided_, in_order_};
    }

private:
    bool reached_ = false;
    bool avoided_ = true;
    bool in_order_ = false;  ///< B at the same step as A or after it
};

}  // namespace

Recording monitor_drive(Episode episode, const Encoder& encoder) {
    dubins::Monitor monitor;
    Truth truth;
    std::vector<Step> steps;
    for (const Car& car : episode.states) {
        Step step{};
        step.embedding = encoder.encode(photograph(car));

        dubins::Inputs inputs;
        inputs.z = step.embedding;
        const dubins::Verdicts verdicts = monitor.step(inputs);

        step.claims = {claim(verdicts.reach), claim(verdicts.avoid), claim(verdicts.reach_avoid),
                       claim(verdicts.sequential)};
        step.distances = {monitor.distance_at_a(), monitor.distance_at_b(),
                          monitor.distance_near_c()};
        for (std::size_t i = 0; i < kPredicates.size(); ++i) {
            step.seen[i] = step.distances[i] <= kThresholds[i];
            step.true_now[i] = kRegions[i].disc.contains(car.position);
        }
        step.true_so_far = truth.step(step.true_now);
        steps.push_back(step);
    }
    return {std::move(episode), std::move(steps)};
}

}  // namespace demo
