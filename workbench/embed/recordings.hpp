// Recordings from which `etlc embed` makes episodes.
// Takes: the --data arguments: videos, folders of images, data sets, archives of arrays, folders
// and patterns of these. Gives: the recordings. Keeps true: their order depends on the arguments
// and the names of the files alone; a recording is opened when its turn comes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
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
    bool is_vector = false;     ///< steps x width, else one number a step
};

/// What is looked for.
struct Search {
    std::vector<std::string> arguments;
    std::string groups;  ///< of .h5 files each that matches is a recording; empty: the file is one
    double rate = 0;     ///< steps a second, 0 where the spec has no rate: then every frame is one
    /// The camera of an input; of "" that of all inputs. Of data sets and arrays.
    std::map<std::string, std::string> cameras;
    std::vector<std::string> inputs;  ///< that encoders make

    /// Of an input; empty: none is named.
    std::string camera(const std::string& input) const;
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
    /// The video, or the images, one a frame; empty: the frames lie among others.
    std::vector<std::string> files{};
    /// What data::open_trace reads the inputs from that no encoder makes; empty: none.
    std::string columns{};
    std::uint64_t stride = 1;          ///< a step every so many rows of these
    std::vector<std::string> tasks{};  ///< what is done in it, in words
};

/// Every recording of the arguments. An argument without a recording is reported; of a data set,
/// episodes that lack something are left out with a warning.
std::vector<Recording> find_recordings(const Search& search, diag::Sink& sink);

}  // namespace etlc::embed
