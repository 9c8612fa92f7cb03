// Frames of images and videos, one after the other: red, green and blue, 8 bits each.
// Keeps true: only one frame is in memory; files are decoded by a separate program, etlc-embed, so
// a hostile file causes a failure with an E10 code at worst. Lists of image files are sorted
// bytewise, whatever the file system or the locale.
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
    ~ImageDecoder();

    /// Decodes the bytes of an image file. After a failure, E1009, the decoder has ended.
    std::optional<diag::Failure> decode(std::string_view bytes, Frame& frame);

private:
    explicit ImageDecoder(std::unique_ptr<Child> child);

    std::unique_ptr<Child> child_;
};

/// Returns the bytes of a PNG file.
diag::Result<std::string> png_of(const Frame& frame);

/// Returns the path of the program that decodes files and runs networks.
std::string embedder_path();
diag::Failure no_embedder();

/// Returns whether the ending of a path is that of an image, in any case.
bool is_image(const std::string& path);
/// Returns ".png, .jpg or .jpeg".
std::string image_endings();

/// Finds the images that `path` names, an image, a folder or a pattern, relative to `folder`.
/// Failures are E1009, and do not repeat the path.
diag::Result<std::vector<std::string>> find_images(const std::string& folder,
                                                   const std::string& path);

}  // namespace etlc::data
