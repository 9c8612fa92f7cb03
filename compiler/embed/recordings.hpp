// Recordings from which `etlc embed` makes episodes.
// Takes: the --data arguments: videos, folders of images, folders and patterns of these. Gives: the
// recordings. Keeps true: their order depends on the arguments and the names of the files alone; a
// recording is opened when its turn comes.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "data/frames/frames.hpp"
#include "diag/diag.hpp"

namespace etlc::embed {

/// An array of a recording that its episode has too, a row a step.
struct Array {
    std::string name;
    std::uint32_t width = 1;
    std::vector<float> values;  ///< steps x width
};

struct Recording {
    std::string path;     ///< for messages
    std::string episode;  ///< name of the episode's file, without its ending
    /// A single camera, whose frames every input is made of.
    bool has_one_camera = true;
    /// The frames for an input, a frame a step. Failures do not repeat the path.
    std::function<diag::Result<std::unique_ptr<data::FrameSource>>(const std::string& input)> open;
    /// A .csv file of its name beside it: see embed/beside.hpp; empty: there is none.
    std::string beside{};
    /// The video, or the images, one a frame.
    std::vector<std::string> files{};
};

/// Every recording of the arguments. `rate`: steps a second, 0 where the spec has no rate: then
/// every frame is a step. An argument without a recording is reported.
std::vector<Recording> find_recordings(const std::vector<std::string>& arguments, double rate,
                                       diag::Sink& sink);

}  // namespace etlc::embed
