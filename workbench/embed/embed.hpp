// `etlc embed`: embeddings of the images and videos that a spec names, and episodes of recordings.
// Takes: the model of check_encoded. Gives: the file of embeddings, and episodes, .npz archives,
// each on disk as soon as it is made. Keeps true: each encoder is started once; an interrupted call
// and its repetition write the bytes of one call; errors name their image, video or model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/embedded.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embed/encoder.hpp"
#include "embed/recordings.hpp"
#include "recordings/open.hpp"

namespace etlc::embed {

/// How far the episodes of a call are.
struct Progress {
    std::size_t done = 0;
    std::size_t of = 0;
    std::size_t encoded = 0;   ///< of those done; the others were there
    std::uint64_t frames = 0;  ///< given to encoders
};

struct Request {
    Running running;
    std::string version;            ///< of etlc
    recordings::NamesInFile names;  ///< names of inputs and labels in data sets and arrays
    std::string folder;             ///< of the episodes; it exists
    std::function<void(const Progress&)> progress;  ///< empty where nobody would see it
};

/// Describes the encoders, without embeddings: their models and settings. Stores the settings of a
/// .json file beside a model in the model's encoders, and the library that runs them in the
/// request.
std::optional<embedded::File> describe_encoders(check::Model& model, Request& request,
                                                diag::Sink& sink);

/// Adds the embeddings of all images and videos that the spec names to the file.
bool embed_targets(const check::Model& model, const Request& request, embedded::File& file,
                   diag::Sink& sink);

std::string episode_path(const std::string& folder, const Recording& recording);

/// Makes an episode of each recording, with the encoded inputs and those that it has columns of.
/// Embeddings that an episode on disk has already are kept. An error leaves the episodes before it.
std::optional<Progress> embed_recordings(const check::Model& model, const embedded::File& file,
                                         const std::vector<Recording>& recordings,
                                         const Request& request, diag::Sink& sink);

}  // namespace etlc::embed
