#include "watch/step_clock.hpp"

#include <algorithm>
#include <cmath>

namespace etlc::watch {

namespace {

using std::chrono::duration;
using std::chrono::duration_cast;

/// The part of a frame's distance to its step by which the clock moves, and the largest distance
/// that counts: together at most 0.5 % of a step a step.
constexpr double kFollows = 0.02;
constexpr double kMostFollowed = 0.25;
/// A frame may be late by this part of a step; frames of a slow camera are, before a step has none.
constexpr double kLate = 0.75;
/// A distance that changes by more shows that the steps of camera and spec have slipped.
constexpr double kSlip = 0.5;
/// The clock does not follow a camera that has slipped within so many steps: one whose clock
/// differs by more than 0.5 % always has.
constexpr std::uint64_t kFreeSteps = 250;
/// The weight of a new interval in the mean.
constexpr double kNewest = 0.1;
/// A frame may be on its way for this long, in steps, when its step is given up.
constexpr double kOnItsWay = 0.5;

StepClock::Time::duration steps_long(double steps, double step_seconds) {
    return duration_cast<StepClock::Time::duration>(duration<double>(steps * step_seconds));
}

}  // namespace

double StepClock::behind(Time time) const {
    return duration<double>(time - *last_).count() / step_;
}

/// A frame belongs to the next step, unless it is early by more than half the time between frames,
/// so that the next frame is nearer, or late by most of a step.
std::uint64_t StepClock::take(Time frame) {
    if (step_ == 0) return 1;
    note_interval(frame);
    if (!last_) {
        last_ = frame;
        return 1;
    }
    const double place = behind(frame);
    double steps = std::floor(place + (interval_ > 0 ? 0.5 * interval_ : 0.5));
    if (steps < 1) return 0;
    if (steps > 1 && place - (steps - 1) < kLate) --steps;
    *last_ += steps_long(steps, step_);
    const auto count = static_cast<std::uint64_t>(steps);
    follow(place - steps, count);
    return count;
}

void StepClock::note_interval(Time frame) {
    if (frame_) {
        const double interval = std::min(duration<double>(frame - *frame_).count() / step_, 1.0);
        interval_ = interval_ == 0 ? interval : interval_ + kNewest * (interval - interval_);
    }
    frame_ = frame;
}

/// Moves the clock towards a frame that is `distance` steps behind its step.
void StepClock::follow(double distance, std::uint64_t steps) {
    const bool has_slipped = std::abs(distance - distance_) > kSlip;
    distance_ = distance;
    free_ = has_slipped ? kFreeSteps : free_ - std::min(free_, steps);
    if (free_ > 0) return;
    *last_ += steps_long(kFollows * std::clamp(distance, -kMostFollowed, kMostFollowed), step_);
}

std::optional<StepClock::Time> StepClock::next_overdue() const {
    if (step_ == 0 || !last_) return std::nullopt;
    return *last_ + steps_long(2 + kOnItsWay, step_) + std::chrono::microseconds(1);  // to round
}

std::uint64_t StepClock::overdue(Time now) {
    if (step_ == 0 || !last_) return 0;
    const double steps = std::floor(behind(now) - 1 - kOnItsWay);
    if (steps < 1) return 0;
    *last_ += steps_long(steps, step_);
    return static_cast<std::uint64_t>(steps);
}

}  // namespace etlc::watch
