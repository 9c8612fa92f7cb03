#include "watch/camera.hpp"

#include <algorithm>
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

}  // namespace etlc::watch
