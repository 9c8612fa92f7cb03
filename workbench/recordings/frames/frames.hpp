// Frames of images and videos, one after the other: red, green and blue, 8 bits each.
// Keeps true: only one frame is in memory; files are decoded by a separate program, etlc-embed, so
// a hostile file causes a failure with an E10 code at worst.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/child.hpp"
#include "diag/diag.hpp"

namespace etlc::recordings {

struct Frame {
    std::uint32_t height = 0;
    std::uint32_t width = 0;
    std::string rgb;  ///< height x width x 3 bytes, row by row from the top
};

/// Returns whether these are the extents of an array of images, steps x rows x columns x 3, or
/// `with_grey` steps x rows x columns.
bool is_shape_of_images(const std::vector<std::uint64_t>& shape, bool with_grey);
/// Returns red, green and blue of grey values.
std::string in_colour(std::string_view grey);

class FrameSource {
public:
    virtual ~FrameSource() = default;
    /// Reads the next frame; false at the end.
    virtual diag::Result<bool> next(Frame& frame) = 0;
    /// Returns the number of frames; nothing where it takes reading all of them.
    virtual std::optional<std::uint64_t> count() const { return std::nullopt; }
};

/// The frames of a video that are wanted, counted from 0 in the order in which they are shown.
struct FrameChoice {
    std::vector<std::uint64_t> only;  ///< these frames, ascending; empty: all from `first` on
    std::uint64_t first = 0;
    std::uint64_t count = UINT64_MAX;  ///< largest number of frames
    /// One frame per step of 1 / rate seconds, from the first on; the frame rate has to be a whole
    /// multiple of this rate. 0: every frame.
    double rate = 0;
    std::uint64_t skipped = 0;  ///< steps to leave out after `first`
    /// The number of frames that the video must have, and whose they are: "of 2 episodes".
    std::optional<std::uint64_t> total;
    std::string total_of;
};

/// Returns whether the ending of a path is that of a video; folders are searched for these.
bool is_video(const std::string& path);

/// Opens a video. Failures do not repeat the path.
diag::Result<std::unique_ptr<FrameSource>> open_video(const std::string& path,
                                                      const FrameChoice& choice);

/// Opens images, a frame each. A failure is about the next image.
diag::Result<std::unique_ptr<FrameSource>> open_images(const std::vector<std::string>& paths);

/// Decodes images in memory, by the rules of image files.
class ImageDecoder {
public:
    static diag::Result<std::unique_ptr<ImageDecoder>> start();
    /// Decodes the bytes of an image file. After a failure, E1009, the decoder has ended.
    std::optional<diag::Failure> decode(std::string_view bytes, Frame& frame);

private:
    explicit ImageDecoder(std::unique_ptr<data::Child> child) : child_(std::move(child)) {}

    std::unique_ptr<data::Child> child_;
};

/// Returns the bytes of a PNG file.
diag::Result<std::string> png_of(const Frame& frame);

/// Returns the path of the program that decodes files and runs networks.
std::string embedder_path();
diag::Failure no_embedder();

// Frames of a source that is watched: a camera, a stream or a pipe, or a video at its own speed.
// Takes: a path or an address. Gives: each frame with the time at which it was decoded. Keeps true:
// nothing here waits; a source that only pauses is not over.

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
    explicit LiveFrames(std::unique_ptr<data::Child> decoder) : decoder_(std::move(decoder)) {}

    static constexpr std::size_t kHeadBytes = 16;  ///< the time, height and width

    bool read_head();

    std::unique_ptr<data::Child> decoder_;
    bool has_head_ = false;   ///< that of the next frame is whole
    std::size_t filled_ = 0;  ///< bytes of its head, or of its pixels
    std::array<char, kHeadBytes> head_{};
    LiveFrame next_;
};

// Reference frames: pictures that etlc draws, the same in every version and on every machine. Two
// encoders are the same if they make the same embeddings of these.
// Keeps true: the pictures have detail at every scale, another mean for each colour and no
// symmetry, so that another crop, filter, flip or order of channels changes their embeddings.

/// Draws a frame of 480 x 640 pixels. `index`: below embedded::kReferenceFrames.
Frame reference_frame(std::uint32_t index);

}  // namespace etlc::recordings
