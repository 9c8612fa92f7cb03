#include "watch/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "artifacts/embedded.hpp"
#include "check/encoders/encoders.hpp"
#include "data/files/file.hpp"

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

using check::Index;
using diag::Code;
using diag::Failure;
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

std::unique_ptr<Encoders> Encoders::start(const check::Model& model,
                                          const std::vector<Index>& inputs, embed::Request request,
                                          const Stop& stop, diag::Sink& sink) {
    std::unique_ptr<Encoders> encoders(
        new Encoders(model, request.running.max_silence_seconds, sink));
    if (!encoders->is_suitable(inputs, request) || !encoders->start_all(inputs, request.running))
        return nullptr;
    // A command's fingerprint says nothing of the command, so that embeddings decide.
    for (const auto& [input, encoder] : encoders->encoders_)
        if (!encoders->compare(input, stop)) return nullptr;
    return encoders;
}

bool Encoders::fail(Index input, const Failure& failure) {
    sink_.report(embed::of_encoder(failure, model_, model_.encoders[model_.inputs[input].encoder]));
    return false;
}

/// Compares fingerprints, as for episodes, and refuses two cameras.
bool Encoders::is_suitable(const std::vector<Index>& inputs, embed::Request& request) {
    check::Model now;
    now.name = model_.name;
    now.file = model_.file;
    now.encoders = model_.encoders;
    if (!embed::describe_encoders(now, request, sink_)) return false;
    std::set<Index> seen;
    for (const Index i : inputs) {
        const check::Input& input = model_.inputs[i];
        const embedded::Marks marks = {{input.name, now.encoders[input.encoder].fingerprint}};
        if (const auto other = check::other_encoder(model_, input, input.name, marks))
            return fail(i, *other);
        if (!seen.insert(input.encoder).second) {
            sink_.report(Code::encoder_use, input.span,
                         fmt::format("'{}' is by the encoder of another input, so of another "
                                     "camera, and this is a video of one",
                                     input.name));
            return false;
        }
    }
    return true;
}

bool Encoders::start_all(const std::vector<Index>& inputs, const embed::Running& running) {
    for (const Index i : inputs) {
        const check::Encoder& encoder = model_.encoders[model_.inputs[i].encoder];
        auto started = embed::Encoder::start(
            encoder, data::beside(model_.file.path(), encoder.model), running);
        if (!started) return fail(i, started.failure());
        children_.push_back(&(*started)->child());
        encoders_[i] = std::move(*started);
    }
    return true;
}

bool Encoders::compare(Index input, const Stop& stop) {
    const check::Encoder& of = model_.encoders[model_.inputs[input].encoder];
    embed::Encoder& encoder = *encoders_.at(input);
    const std::vector<float>& expected = of.references;
    for (std::uint32_t frame = 0; frame < embedded::kReferenceFrames; ++frame) {
        std::vector<float> row;
        bool is_there = false;
        const auto done = [&](std::vector<float> found) {
            row = std::move(found);
            is_there = true;
        };
        if (auto failure =
                encoder.add(recordings::reference_frame(frame), "a reference frame", done))
            return fail(input, *failure);
        given_ = std::chrono::steady_clock::now();
        while (!is_there) {
            constexpr int kMilliseconds = 1000;  // to look whether it is silent too long
            data::Child::await({&encoder.child()}, {stop.descriptor()}, kMilliseconds);
            if (stop.is_asked() || !take(input)) return false;
        }
        if (expected.size() != embedded::kReferenceFrames * row.size())
            return fail(input, {Code::other_encoder,
                                fmt::format("'{}' makes {} of a frame, not the {} that it made for "
                                            "etlc embed",
                                            of.name, diag::counted(row.size(), "number"),
                                            expected.size() / embedded::kReferenceFrames)});
        const double difference =
            embedded::relative_difference(row.data(), &expected[frame * row.size()], row.size());
        if (difference > embedded::kSameEncoder)
            return fail(input, {Code::other_encoder,
                                fmt::format("'{}' makes other embeddings than when `etlc embed` "
                                            "ran: of reference frame {} they differ by {:.2g}, "
                                            "expected at most {}",
                                            of.name, frame, difference, embedded::kSameEncoder)});
    }
    return true;
}

bool Encoders::give(const recordings::Frame& frame) {
    waiting_ = encoders_.size();
    given_ = std::chrono::steady_clock::now();
    for (const auto& [input, encoder] : encoders_) {
        const auto done = [this, at = input](std::vector<float> row) {
            rows_[at] = std::move(row);
            --waiting_;
        };
        if (auto failure = encoder->add(frame, "the video", done)) return fail(input, *failure);
    }
    return true;
}

bool Encoders::take() {
    const auto takes = [this](const auto& one) { return take(one.first); };
    return waiting_ == 0 || std::all_of(encoders_.begin(), encoders_.end(), takes);
}

bool Encoders::take(Index input) {
    embed::Encoder& encoder = *encoders_.at(input);
    const bool is_late = std::chrono::steady_clock::now() - given_ > most_;
    if (auto failure = encoder.child().is_over() ? encoder.take_all() : encoder.take())
        return fail(input, *failure);
    if (!is_late || encoder.is_idle()) return true;
    return fail(input,
                {Code::encoder_failed,
                 fmt::format("'{}' has made no embedding of a frame for {}; it has "
                             "to write, and flush, one after every frame",
                             model_.encoders[model_.inputs[input].encoder].name,
                             diag::counted(static_cast<std::uint64_t>(most_.count()), "second"))});
}

}  // namespace etlc::watch
