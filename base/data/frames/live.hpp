// Frames of a source that is watched: a camera, a stream or a pipe, or a video at its own speed.
// Takes: a path or an address. Gives: each frame with the time at which it was decoded. Keeps true:
// nothing here waits; a source that only pauses is not over.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "data/files/child.hpp"
#include "data/frames/frames.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

using LiveTime = std::chrono::steady_clock::time_point;

struct LiveFrame {
    Frame frame;
    LiveTime time;
};

/// Returns whether frames go on to arrive while nobody reads them: false for a file.
bool is_live_source(const std::string& source);

/// Says why there is no such source, as far as that shows without opening it.
std::optional<diag::Failure> why_no_source(const std::string& source);

class LiveFrames {
public:
    /// Opens a source. `rate`: steps a second of a file, as FrameChoice::rate. Failures do not
    /// repeat the source.
    static diag::Result<std::unique_ptr<LiveFrames>> open(const std::string& source, double rate);

    /// The descriptor that can be read when more has come, for Child::await.
    int descriptor() const { return decoder_->output(); }
    /// Takes a frame, if a whole one has arrived.
    diag::Result<bool> take(LiveFrame& frame);
    /// Returns whether `take` has taken all frames, and no more come.
    bool is_over() const { return decoder_->has_ended(); }
    /// Returns how the source ended, once it is over: nothing where that was its end.
    std::optional<diag::Failure> ending();

private:
    explicit LiveFrames(std::unique_ptr<Child> decoder) : decoder_(std::move(decoder)) {}

    static constexpr std::size_t kHeadBytes = 16;  ///< the time, height and width

    bool read_head();

    std::unique_ptr<Child> decoder_;
    bool has_head_ = false;   ///< that of the next frame is whole
    std::size_t filled_ = 0;  ///< bytes of its head, or of its pixels
    std::array<char, kHeadBytes> head_{};
    LiveFrame next_;
};

}  // namespace etlc::data
