// The recordings from which `etlc embed` makes episodes.
// Takes: the --data arguments: videos, folders of images, data sets, archives of arrays, folders
// and patterns of these. Keeps true: the order of recordings depends only on the arguments and the
// names of files; a recording is opened when it is encoded.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embed/encoder.hpp"
#include "recordings/frames/frames.hpp"
#include "recordings/open.hpp"

namespace etlc::embed {

/// An array of a recording that is copied to its episode, a row a step.
struct Array {
    std::string name;
    std::uint32_t width = 1;
    std::vector<float> values;  ///< steps x width
    bool is_vector = false;     ///< shape steps x width, else one number a step
};

struct Search {
    std::vector<std::string> arguments;
    std::string
        groups;  ///< pattern of the groups of .h5 files that are recordings; empty: the file is one
    double rate = 0;  ///< steps a second; 0 where the spec has no rate: every frame is a step
    /// Cameras of data sets and arrays by input; "" stands for all inputs.
    std::map<std::string, std::string> cameras;
    std::vector<std::string> inputs;  ///< inputs made by encoders

    /// Returns the camera named for an input, or "".
    std::string camera(const std::string& input) const;
};

/// All that decides which frames an input gets.
struct Origin {
    std::string video;               ///< its path; empty: the frames are not in a video
    std::vector<std::string> files;  ///< other files, in an order that matters
    std::string choice;              ///< which frames of them are taken
};

struct Recording {
    std::string path;     ///< for messages
    std::string episode;  ///< name of the episode's file, without its ending
    /// One camera, whose frames all inputs are made of.
    bool has_one_camera = true;
    /// Opens the frames for an input, a frame a step. Failures do not repeat the path.
    std::function<diag::Result<std::unique_ptr<recordings::FrameSource>>(const std::string& input)>
        open;
    std::function<Origin(const std::string& input)> origin;
    /// A .csv file of the same name beside it, with other inputs and labels; empty: none.
    std::string beside{};
    /// The video, or the image of each frame; empty: the file also holds other recordings.
    std::vector<std::string> files{};
    /// The path from which recordings::open_trace reads the other inputs; empty: none.
    std::string columns{};
    std::uint64_t stride = 1;          ///< rows per step
    std::vector<std::string> tasks{};  ///< descriptions of what is done in it
};

/// Finds the recordings of all arguments. Reports an argument without recordings; warns of
/// incomplete episodes of data sets, which are left out.
std::vector<Recording> find_recordings(const Search& search, diag::Sink& sink);

// What a recording has besides frames: the inputs that no encoder makes, and labels.
// Takes: a recording, and the table beside it. Gives: arrays with a row a step. Keeps true: a
// column with the name of an encoded input is a failure; failures do not repeat the path.

/// Reads the .csv file beside a recording: a column for each number, a row for each step, labels in
/// columns `truth.NAME`, empty cells for missing samples. Failures have E08 codes.
diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path);

/// Reads the inputs that no encoder makes, and the labels that `names` has, from
/// `recording.columns`.
diag::Result<std::vector<Array>> arrays_in(const check::Model& model, const Recording& recording,
                                           const recordings::NamesInFile& names);

// Embeddings of an earlier call, with which an interrupted call goes on.
// Takes: a recording, and the episode that is on disk. Gives: the embeddings of an input that the
// episode already has. Keeps true: they are those that would be made again; contents decide, not
// names or times; embeddings that were changed, or whose origin cannot be told, are not taken.

class Earlier {
public:
    /// `version`: of etlc, which prepares the frames.
    Earlier(const Running& running, const std::string& version);

    /// Lists all that the embeddings of an input are made from, by hashes of contents; empty where
    /// it cannot be told. `encoder`: its fingerprint.
    std::string origin(const Recording& recording, const std::string& input,
                       const std::string& encoder);

private:
    /// Returns the hash of a file; empty where it cannot be read.
    std::string hash(const std::string& path, bool is_shared);

    std::string made_by_;  ///< version, and the command with its files, or the library of networks
    std::map<std::string, std::string> shared_;  ///< hashes of files with several recordings
};

/// Returns the hash that an episode stores for an input: of its origin and its embeddings.
std::string bound(const std::string& origin, std::uint32_t dimension,
                  const std::vector<float>& rows);

/// Returns the embeddings of an input in an episode; nothing where they are not of this origin.
std::optional<std::vector<float>> embeddings_in(const std::string& episode,
                                                const std::string& input, std::uint32_t dimension,
                                                const std::string& origin);

}  // namespace etlc::embed
