// The camera's frame at a step of an episode, for the page.
// Takes: what --frames names. Gives: an image file. Keeps true: a frame is exactly that of its
// step, counted by the decoder; memory is that of an episode's small pictures, up to a limit; files
// that have gone are a failure for this frame alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "data/frames/frames.hpp"
#include "diag/diag.hpp"
#include "label/desk.hpp"
#include "report/pictures.hpp"

namespace etlc::label {

struct FramesRequest {
    /// An array or a pattern as for `etlc report`, or the folder of a data set, whose episode is
    /// that of the number at the end of the name.
    report::FramesOption option;
    std::string camera;  ///< of the data set; empty: its only one
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
    bool has(const Episode& episode) const;
    diag::Result<ImageFile> at(const Episode& episode, std::uint64_t step);

private:
    diag::Result<std::unique_ptr<data::FrameSource>> open(const Episode& episode,
                                                          std::uint64_t from);
    diag::Result<std::unique_ptr<data::FrameSource>> open_dataset(const std::string& episode);
    std::string dataset_episode(const Episode& episode) const;
    std::optional<diag::Failure> read_up_to(std::uint64_t step);
    void make_room(std::uint64_t step);

    FramesRequest request_;
    std::string episode_;  ///< whose frames the members below are
    std::unique_ptr<data::FrameSource> source_;
    std::string file_;                                   ///< of the source, for messages
    bool can_skip_ = false;                              ///< the source may begin at any step
    std::uint64_t next_ = 0;                             ///< step of the source's next frame
    std::map<std::uint64_t, report::Picture> pictures_;  ///< by step
    std::size_t bytes_ = 0;
};

}  // namespace etlc::label
