// Frames of a source that is watched: a camera, a stream or a pipe, or a video at its own speed.
// Takes: a path or an address. Gives: each frame with the time at which it was decoded. Keeps true:
// nothing here waits; a source that only pauses is not over.
#pragma once

#include <chrono>
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

    /// The program that decodes, for Child::await.
    Child& decoder() { return *decoder_; }
    /// Takes a frame, if a whole one has arrived.
    diag::Result<bool> take(LiveFrame& frame);
    /// Returns whether no whole frame is left, and no more come.
    bool is_over() const { return decoder_->has_ended() && decoder_->arrived() < missing(); }
    /// Returns how the source ended, once it is over: nothing where that was its end.
    std::optional<diag::Failure> ending();

private:
    explicit LiveFrames(std::unique_ptr<Child> decoder) : decoder_(std::move(decoder)) {}

    /// Returns the bytes that are to come of the next frame or its head.
    std::size_t missing() const;

    std::unique_ptr<Child> decoder_;
    bool has_head_ = false;  ///< that of the next frame has been read, into `next_`
    LiveFrame next_;
};

}  // namespace etlc::data
