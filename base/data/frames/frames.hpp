// Frames of images and videos, one after the other.
// Takes: a file, and which of its frames are wanted. Gives: frames of red, green and blue, 8 bits
// each. Keeps true: memory is that of one frame; files are decoded by a program of its own,
// etlc-embed, so whatever they do to it, here it is a failure with an E10 code.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

class Child;

struct Frame {
    std::uint32_t height = 0;
    std::uint32_t width = 0;
    std::string rgb;  ///< height x width x 3 bytes, row by row from the top
};

class FrameSource {
public:
    virtual ~FrameSource() = default;
    /// Reads the next frame; false at the end.
    virtual diag::Result<bool> next(Frame& frame) = 0;
};

/// Which frames of a video, counted from 0 as they are shown.
struct FrameChoice {
    std::vector<std::uint64_t> only;  ///< these, ascending; empty: all from `first` on
    std::uint64_t first = 0;
    std::uint64_t count = UINT64_MAX;  ///< at most
    /// A frame a step of 1 / rate seconds, from the first on; the frames have to come at a whole
    /// multiple of the rate. 0: every frame.
    double rate = 0;
    /// The frames that the video has to have, and whose they are: "of 2 episodes".
    std::optional<std::uint64_t> total;
    std::string total_of;
};

/// Whether the ending of a path is that of a video that is looked for in folders.
bool is_video(const std::string& path);

/// Opens a video. Failures do not repeat the path.
diag::Result<std::unique_ptr<FrameSource>> open_video(const std::string& path,
                                                      const FrameChoice& choice);

/// Opens images, a frame each. Failures are about the first image that has not been given.
diag::Result<std::unique_ptr<FrameSource>> open_images(const std::vector<std::string>& paths);

/// Decodes images whose bytes are at hand, with the rules of image files.
class ImageDecoder {
public:
    static diag::Result<std::unique_ptr<ImageDecoder>> start();
    ~ImageDecoder();

    /// `bytes`: as a file of the image has them. After a failure, E1009, there is nothing more.
    std::optional<diag::Failure> decode(std::string_view bytes, Frame& frame);

private:
    explicit ImageDecoder(std::unique_ptr<Child> child);

    std::unique_ptr<Child> child_;
};

/// The program that decodes and runs networks.
std::string embedder_path();
diag::Failure no_embedder();

}  // namespace etlc::data
