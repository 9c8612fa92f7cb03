// The camera's frame at a step of an episode, for the page.
// Takes: what --frames names. Gives: an image file. Keeps true: a frame is exactly that of its
// step, counted by the decoder, and the episode has as many of them as steps; memory is that of an
// episode's small pictures, up to a limit; files that have gone are a failure for this frame alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "diag/diag.hpp"
#include "label/desk.hpp"
#include "report/pictures.hpp"

namespace etlc::label {

struct FramesRequest {
    report::FramesOption option;
    double step_seconds = 0;
};

struct ImageFile {
    std::string type;  ///< "image/png"
    std::string bytes;
};

/// Returns the picture as a file that browsers show and that costs no compression: a bitmap of
/// blue, green and red, rows from the bottom, each padded to four bytes.
ImageFile bitmap(const report::Picture& picture);

class Frames {
public:
    explicit Frames(FramesRequest request) : request_(std::move(request)) {}

    /// Returns whether there may be frames of an episode.
    bool has(const Episode& episode) const {
        return report::names_frames(request_.option, episode.path);
    }
    diag::Result<ImageFile> at(const Episode& episode, std::uint64_t step);

private:
    diag::Result<report::Film> open(const Episode& episode, std::uint64_t from) const;
    std::optional<diag::Failure> check_end(const Episode& episode) const;
    std::optional<diag::Failure> read_up_to(std::uint64_t step);
    void make_room(std::uint64_t step);

    FramesRequest request_;
    std::string episode_;  ///< whose frames the members below are
    report::Film film_;
    bool belongs_ = false;                               ///< the film has a frame for each step
    std::map<std::uint64_t, report::Picture> pictures_;  ///< by step
    std::size_t bytes_ = 0;
};

}  // namespace etlc::label
