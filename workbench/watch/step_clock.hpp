// Which step a frame of a live source belongs to.
// Takes: the times at which frames arrive, and the time that it is now. Gives: steps, in order.
// Keeps true: a step is 1 / rate seconds after the one before, whether or not a frame came: where
// none did, the step has no sample, and the steps behind it do not move. The clock follows a camera
// whose clock differs by at most half a percent (29.97 frames a second are 30), as `etlc embed`
// does with files.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace etlc::watch {

class StepClock {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// `step_seconds`: 0 where every frame is a step.
    explicit StepClock(double step_seconds) : step_(step_seconds) {}

    /// Returns the number of steps up to that of this frame, all but the last without a frame: 1
    /// for the next step, 0 for a frame more than the steps need, or one that comes too late.
    std::uint64_t take(Time frame);
    /// Returns the number of steps that no later frame can belong to.
    std::uint64_t overdue(Time now);
    /// Returns when the next step becomes overdue; nothing where steps wait for frames.
    std::optional<Time> next_overdue() const;

private:
    /// Returns how many steps after the last one a time is.
    double behind(Time time) const;
    void note_interval(Time frame);
    void follow(double distance, std::uint64_t steps);

    double step_;
    std::optional<Time> last_;   ///< time of the last step
    std::optional<Time> frame_;  ///< of the last frame
    double interval_ = 0;        ///< mean time between frames, in steps; 0: unknown
    double distance_ = 0;        ///< of the last step's frame behind its step, in steps
    std::uint64_t free_ = 0;     ///< steps for which the clock does not follow
};

}  // namespace etlc::watch
