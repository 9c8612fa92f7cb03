// The steps of a live source: a frame or none for each, and its embeddings.
// Takes: the frames of a camera, and the encoders. Gives: a trace, whose next step comes when the
// embedding of its frame has, or when the step has passed without a frame. Keeps true: a frame that
// is left out, because the encoders are busy, is a step without a sample, at its place in time. Of
// a file no frame is left out.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "data/traces/trace.hpp"
#include "diag/diag.hpp"
#include "embed/embed.hpp"
#include "recordings/frames/frames.hpp"
#include "watch/watch.hpp"

namespace etlc::watch {

// The encoders of a live source.
// Takes: a frame at a time. Gives: the embeddings of the inputs that monitors read. Keeps true: no
// frame is encoded before every encoder has shown that it is the one of calibration: its
// fingerprint is that of the spec's embeddings, and what it makes of the reference frames too.

class Encoders {
public:
    /// Starts the encoders of these inputs; the arguments outlive them. Returns nothing after an
    /// error, which it reports, and where somebody has asked for the end.
    static std::unique_ptr<Encoders> start(const check::Model& model,
                                           const std::vector<check::Index>& inputs,
                                           embed::Request request, const Stop& stop,
                                           diag::Sink& sink);

    /// Passes a frame to all encoders, which have finished the one before.
    bool give(const recordings::Frame& frame);
    /// Takes the embeddings that have arrived; false after an error.
    bool take();
    /// Returns whether all embeddings of the last frame are there.
    bool are_done() const { return waiting_ == 0; }
    const std::vector<float>& embedding(check::Index input) const { return rows_.at(input); }
    /// The programs that run, for data::Child::await.
    const std::vector<data::Child*>& children() const { return children_; }

private:
    Encoders(const check::Model& model, int seconds, diag::Sink& sink)
        : model_(model), sink_(sink), most_(seconds) {}

    bool is_suitable(const std::vector<check::Index>& inputs, embed::Request& request);
    bool start_all(const std::vector<check::Index>& inputs, const embed::Running& running);
    bool compare(check::Index input, const Stop& stop);
    /// Takes what has arrived of an encoder; false where it has failed, or is silent too long.
    bool take(check::Index input);
    bool fail(check::Index input, const diag::Failure& failure);

    const check::Model& model_;
    diag::Sink& sink_;
    std::map<check::Index, std::unique_ptr<embed::Encoder>> encoders_;  ///< by input
    std::map<check::Index, std::vector<float>> rows_;                   ///< by input
    std::vector<data::Child*> children_;
    std::chrono::seconds most_;  ///< --encoder-timeout
    std::chrono::steady_clock::time_point given_;
    std::size_t waiting_ = 0;  ///< embeddings of the last frame that are to come
};

// Which step a frame of a live source belongs to.
// Takes: the times at which frames arrive, and the time that it is now. Gives: steps, in order.
// Keeps true: a step is 1 / rate seconds after the one before, whether or not a frame came: where
// none did, the step has no sample, and the steps after it do not move. The clock follows a camera
// whose clock differs by at most half a percent (29.97 frames a second are 30), as `etlc embed`
// does with files.

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

struct CameraCounts {
    std::uint64_t frames = 0;   ///< that came
    std::uint64_t dropped = 0;  ///< of these, left out while the encoders were busy
    std::uint64_t late = 0;     ///< of these, more than the steps need, or too late for theirs
    std::uint64_t absent = 0;   ///< steps for which no frame came
};

class Camera {
public:
    Camera(std::unique_ptr<recordings::LiveFrames> frames, std::unique_ptr<Encoders> encoders,
           bool is_live, double step_seconds, const Stop& stop)
        : frames_(std::move(frames)),
          encoders_(std::move(encoders)),
          stop_(stop),
          is_live_(is_live),
          clock_(is_live ? step_seconds : 0) {}

    /// Waits for the next step; false at the end of the source, or where somebody asked for it.
    diag::Result<bool> next();

    /// Returns the frame of this step; null where it has none.
    const recordings::Frame* frame() const { return has_frame_ ? &frame_ : nullptr; }
    const std::vector<float>& embedding(check::Index input) const {
        return encoders_->embedding(input);
    }
    const CameraCounts& counts() const { return counts_; }
    /// Returns whether an encoder has failed, which it has reported.
    bool has_failed() const { return has_failed_; }

private:
    /// A step that has come, and was not yet given out.
    struct Due {
        bool has_frame = false;
        bool is_given = false;  ///< to the encoders
        recordings::Frame frame;
    };

    bool fail() { return !(has_failed_ = true); }
    /// Returns whether the first step can be given out, after passing its frame on.
    bool is_ready();
    void give_out();
    diag::Result<bool> wait();
    diag::Result<bool> take_frames();
    void add(recordings::LiveFrame& frame);
    void add_absent(std::uint64_t steps);
    int patience() const;
    bool wants_frames() const { return is_live_ || due_.size() < 2; }

    std::unique_ptr<recordings::LiveFrames> frames_;
    std::unique_ptr<Encoders> encoders_;
    const Stop& stop_;
    bool is_live_;
    StepClock clock_;
    std::deque<Due> due_;
    recordings::LiveFrame arrived_;
    recordings::Frame frame_;  ///< of the last step that has one
    recordings::Frame spare_;  ///< whose memory the next frame takes
    bool has_frame_ = false;
    bool has_failed_ = false;
    CameraCounts counts_;
};

/// A camera as a trace, whose channels are the encoded inputs.
class CameraTrace final : public data::Trace {
public:
    /// `inputs`: by channel, those that the camera gives; kNone for others, which it lacks.
    CameraTrace(Camera& camera, std::vector<check::Index> inputs,
                std::vector<data::Channel> channels)
        : camera_(camera), inputs_(std::move(inputs)), channels_(std::move(channels)) {}

    diag::Result<bool> next(data::Sample& sample) override;
    bool has(std::size_t channel) const override { return inputs_[channel] != check::kNone; }

private:
    Camera& camera_;
    std::vector<check::Index> inputs_;
    std::vector<data::Channel> channels_;
};

}  // namespace etlc::watch
