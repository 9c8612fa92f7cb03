// Camera pictures: the frames of an episode, which `etlc label` shows too, and small ones for the
// page. Pictures from an array or a video come as one PNG, others as their own files. Each picture
// is shown at its own step; an episode with other numbers of pictures and steps has none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "recordings/frames/frames.hpp"

namespace etlc::report {

/// The values of --frames and --camera: an array of the episodes; a pattern with {episode} of
/// files, one per step, or of videos, one per episode; or the folder of a data set.
struct FramesOption {
    std::string text;    ///< as given; empty: none, except for episodes of a data set
    std::string camera;  ///< of the data set; empty: its only one

    bool is_pattern() const;
};

/// The pictures of an episode.
struct Pictures {
    std::vector<std::uint64_t> steps;  ///< steps with a picture
    std::vector<std::string> files;    ///< data: addresses, one per step, or one of a PNG in which
    std::uint32_t width = 0;           ///< pictures of this size are stacked
    std::uint32_t height = 0;
    std::string why;  ///< reason why there are none

    std::uint64_t bytes() const;
};

/// The length of an episode. A video gives one frame per step of 1 / rate seconds; 0: every frame.
struct Length {
    std::uint64_t steps = 0;
    double rate = 0;
};

/// The frames of an episode: image files, one per step, or frames one after the other.
struct Film {
    std::vector<std::string> images;
    std::unique_ptr<recordings::FrameSource> frames;
    std::string path;        ///< of the frames, for messages; empty: of the episode
    std::uint64_t next = 0;  ///< step of the next frame
    bool can_skip = false;   ///< it may be opened at any step
};

/// Checks that a pattern names different pictures for each episode. Reports E0840 and returns false
/// where it does not.
bool check_pattern(const FramesOption& option, std::size_t episodes, diag::Sink& sink);

/// Returns whether the option names frames of an episode, though perhaps none that belong to it.
bool names_frames(const FramesOption& option, const std::string& episode);

/// Opens the frames of an episode at a step, or where it cannot skip at the first one. Frames that
/// do not belong to the episode are E0840: none, other numbers of them and steps (for a video only
/// its end tells), an episode of another data set. Other failures are about a file or an array.
diag::Result<Film> open_film(const FramesOption& option, const std::string& episode,
                             const Length& length, std::uint64_t from);

/// Reads pictures of an episode: of the first and the last step, of `telling` ones, the first of
/// them first, as many as there is room for, and then of evenly chosen ones. Failures (a file or an
/// array without pictures) do not name the episode.
diag::Result<Pictures> pictures_of(const FramesOption& option, const std::string& episode,
                                   const Length& length, const std::vector<std::uint64_t>& telling,
                                   std::uint64_t most_bytes);

/// An 8-bit RGB picture.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::string pixels;  ///< rows from the top, red, green, blue
};

/// Returns a data: address of the picture as PNG (ISO/IEC 15948).
std::string address(const Picture& picture);

inline constexpr std::uint32_t kMostPixels = 96;  ///< longest side of pictures on the page

/// Shrinks a picture to sides of at most `most` pixels, each the mean of the pixels in its place.
Picture shrunk(std::string_view pixels, std::uint32_t width, std::uint32_t height,
               std::uint32_t channels, std::uint32_t most);

/// By declared target: a data: address or an empty text for each row.
using TargetPictures = std::map<check::Index, std::vector<std::string>>;

/// Returns the pictures of target rows that are images or frames of a video, for the targets from
/// which the predicates measure. Rows that do not fit into `most_bytes` have none. A target whose
/// images cannot be decoded any more has none either, with a warning; verdicts depend on its
/// embeddings only.
TargetPictures pictures_of_targets(const check::Model& model,
                                   const std::vector<check::Index>& predicates,
                                   std::uint64_t most_bytes, diag::Sink& sink);

}  // namespace etlc::report
