// What the camera saw, small enough for a page.
// Takes: what --frames names, and an episode. Gives: pictures of some of its steps, evenly: one PNG
// of all of them where they come from an array or a video, else the files as they are. Keeps true:
// a picture stands beside the step that it was taken at; where pictures and steps are not as many,
// there are none.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::report {

/// What --frames names: an array of the episodes, or files, one a step, or videos, one an episode,
/// by a pattern with {episode} in it.
struct FramesOption {
    std::string text;  ///< as given; empty: none

    bool is_pattern() const;
};

/// The pictures of an episode; none: they are not there, or not one a step, as `why` says.
struct Pictures {
    std::vector<std::uint64_t> steps;  ///< that they are of
    std::vector<std::string> files;    ///< data: addresses of files, one a step; or of one PNG,
    std::uint32_t width = 0;           ///< in which pictures of this size stand one below the other
    std::uint32_t height = 0;
    std::string why;

    std::uint64_t bytes() const;
};

/// How long an episode is. Of a video one frame a step of 1 / rate seconds is taken; 0: every one.
struct Length {
    std::uint64_t steps = 0;
    double rate = 0;
};

/// Failures do not name the episode: a file that is no picture, an array that holds none.
diag::Result<Pictures> pictures_of(const FramesOption& option, const std::string& episode,
                                   const Length& length, std::uint64_t most_bytes);

}  // namespace etlc::report
