// Monitors as detectors of failures: what their alarms say about episodes whose outcome is known.
// No truth of a predicate and no label of a frame is read. An alarm is a verdict that is violated
// for good.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluate/figures.hpp"

namespace etlc::evaluate {

/// How an episode went, and what a monitor said to it.
struct Judged {
    episodes::Outcome outcome;
    std::uint64_t frames = 0;
    std::uint32_t fold = 0;
    std::uint32_t group = 0;
    std::optional<std::uint64_t> alarm;  ///< the step of the first alarm
    float least_upper = 0;               ///< the least upper bound over all steps

    bool succeeded() const { return outcome.kind == episodes::Outcome::Kind::success; }
    bool failed() const { return outcome.kind == episodes::Outcome::Kind::failure; }
};

/// The rates of a detector, or of a rule that reads no sample.
template <class T>
struct DetectionRates {
    T false_alarms;       ///< successes with an alarm / successes
    T detected;           ///< failures with an alarm / failures
    T balanced_accuracy;  ///< (1 - false_alarms + detected) / 2

    template <class Visit>
    void for_each(Visit&& visit) const {
        visit("false_alarm_rate", false_alarms);
        visit("detection_rate", detected);
        visit("balanced_accuracy", balanced_accuracy);
    }
};

/// Undefined without successes or without failures.
struct OutcomeScore : DetectionRates<Figure> {
    std::uint64_t successes = 0;
    std::uint64_t failures = 0;
    std::uint64_t false_alarm_count = 0;
    std::uint64_t detected_count = 0;
    /// P(the least upper bound of a failure is below that of a success) + P(equal) / 2.
    Figure auroc;
    /// Steps from the alarm to the failure, or to the last step, of the detected failures: the
    /// least number with a quarter, half and three quarters of them at or below it.
    Figure warning_lower_quartile;
    Figure warning_median;
    Figure warning_upper_quartile;
    /// Alarms in every episode, in none, and by the number of steps alone: from a to b, each
    /// episode by the two numbers with the greatest balanced accuracy on all others.
    std::vector<std::pair<std::string, DetectionRates<std::optional<double>>>> baselines;
};

/// Returns the figures over the episodes with an outcome; nothing if none succeeded or failed.
/// Intervals of rates are Wilson's ("Probable inference, the law of succession, and statistical
/// inference", 1927), those of the others from resamples. Where episodes have groups, those of
/// rates are from resamples too, or Wilson's of as many groups where all or none have an alarm.
std::optional<OutcomeScore> outcome_score(const Bootstrap& bootstrap,
                                          const std::vector<Judged>& episodes, bool by_group);

/// Returns for each episode whether the rule by its number of steps raises an alarm.
std::vector<bool> alarms_by_duration(const std::vector<Judged>& episodes);

/// Returns Wilson's 95 % interval of a share.
Interval wilson(std::uint64_t part, std::uint64_t whole);

}  // namespace etlc::evaluate
