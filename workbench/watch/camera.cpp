#include "watch/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etlc::watch {

diag::Result<bool> Camera::next() {
    while (!stop_.is_asked()) {
        if (is_ready()) {
            give_out();
            return true;
        }
        if (has_failed_) return false;
        const auto more = wait();
        if (!more || !*more) return more;
    }
    return false;
}

bool Camera::is_ready() {
    if (due_.empty()) return false;
    Due& due = due_.front();
    if (!due.has_frame) return true;
    if (!due.is_given && !encoders_->give(due.frame)) return fail();
    due.is_given = true;
    return encoders_->are_done();
}

void Camera::give_out() {
    Due& due = due_.front();
    has_frame_ = due.has_frame;
    if (has_frame_) {
        spare_ = std::move(frame_);
        frame_ = std::move(due.frame);
    }
    due_.pop_front();
}

/// Waits for frames and embeddings; false once the source is over and all its frames are out.
diag::Result<bool> Camera::wait() {
    const bool is_over = frames_->is_over();
    if (is_over && due_.empty()) {
        if (auto failure = frames_->ending()) return *failure;
        return false;
    }
    const int source = !is_over && wants_frames() ? frames_->descriptor() : -1;
    data::Child::await(encoders_->children(), {stop_.descriptor(), source}, patience());
    if (!encoders_->take()) return fail();
    if (!is_over && wants_frames())
        if (const auto taken = take_frames(); !taken) return taken;
    if (!is_over) add_absent(clock_.overdue(std::chrono::steady_clock::now()));
    return true;
}

diag::Result<bool> Camera::take_frames() {
    for (;;) {
        const auto taken = wants_frames() ? frames_->take(arrived_) : diag::Result<bool>(false);
        if (!taken || !*taken) return taken;
        add(arrived_);
    }
}

/// Returns the milliseconds until a step is overdue, or until it is time to look at the encoders.
int Camera::patience() const {
    using namespace std::chrono;
    constexpr std::int64_t kLongest = 1000;
    const auto next = clock_.next_overdue();
    if (!next || frames_->is_over()) return kLongest;
    const auto left = ceil<milliseconds>(*next - steady_clock::now()).count();
    return static_cast<int>(std::clamp<std::int64_t>(left, 0, kLongest));
}

void Camera::add(recordings::LiveFrame& frame) {
    ++counts_.frames;
    const std::uint64_t steps = clock_.take(frame.time);
    if (steps == 0) {
        ++counts_.late;
        return;
    }
    // The newest frame alone waits for the encoders; the first one is with them, or about to be.
    for (std::size_t i = 1; i < due_.size(); ++i)
        if (is_live_ && due_[i].has_frame) {
            due_[i] = Due();
            ++counts_.dropped;
        }
    add_absent(steps - 1);
    due_.push_back({true, false, std::move(frame.frame)});
    frame.frame = std::move(spare_);
}

void Camera::add_absent(std::uint64_t steps) {
    counts_.absent += steps;
    for (; steps > 0; --steps) due_.emplace_back();
}

diag::Result<bool> CameraTrace::next(data::Sample& sample) {
    const auto more = camera_.next();
    if (!more || !*more) return more;
    const bool has_frame = camera_.frame() != nullptr;
    sample.values.resize(channels_.size());
    sample.present.assign(channels_.size(), false);
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        sample.present[c] = has_frame && has(c);
        if (!sample.present[c]) {
            sample.values[c].assign(channels_[c].width, std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        const std::vector<float>& row = camera_.embedding(inputs_[c]);
        sample.values[c].assign(row.begin(), row.end());
    }
    return true;
}

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
