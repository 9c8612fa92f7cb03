#include "watch/step_clock.hpp"

#include <algorithm>
#include <cmath>

namespace etlc::watch {

namespace {

using std::chrono::duration;
using std::chrono::duration_cast;

/// The part of a frame's distance to its step by which the clock moves. The distance is at most
/// half a step, so the clock moves by at most 0.5 % of a step a step.
constexpr double kFollows = 0.01;
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

/// A frame belongs to the step to which it is nearest. Where frames come faster than steps, it may
/// be early by half the time between frames only: the next frame is then no nearer.
std::uint64_t StepClock::take(Time frame) {
    if (step_ == 0) return 1;
    if (frame_) {
        const double interval = std::min(duration<double>(frame - *frame_).count() / step_, 1.0);
        interval_ = interval_ == 0 ? interval : interval_ + kNewest * (interval - interval_);
    }
    frame_ = frame;
    if (!last_) {
        last_ = frame;
        return 1;
    }
    const double early = interval_ > 0 ? 0.5 * interval_ : 0.5;
    const double steps = std::floor(behind(frame) + early);
    if (steps < 1) return 0;
    *last_ += steps_long(steps, step_);
    *last_ += steps_long(kFollows * std::clamp(behind(frame), -0.5, 0.5), step_);
    return static_cast<std::uint64_t>(steps);
}

std::optional<StepClock::Time> StepClock::next_overdue() const {
    if (step_ == 0 || !last_) return std::nullopt;
    return *last_ + steps_long(2 + kOnItsWay, step_);
}

std::uint64_t StepClock::overdue(Time now) {
    if (step_ == 0 || !last_) return 0;
    const double steps = std::floor(behind(now) - 1 - kOnItsWay);
    if (steps < 1) return 0;
    *last_ += steps_long(steps, step_);
    return static_cast<std::uint64_t>(steps);
}

}  // namespace etlc::watch
