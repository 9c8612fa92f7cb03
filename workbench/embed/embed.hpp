// `etlc embed`: embeddings of the images and videos that a spec names, and episodes of recordings.
// Takes: the model of check_encoded. Gives: the file of embeddings, and episodes as the bytes of
// .npz archives. Keeps true: each encoder is started once; errors name their image, video or model.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/embedded.hpp"
#include "check/model/model.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"
#include "embed/encoder.hpp"
#include "embed/recordings.hpp"

namespace etlc::embed {

struct Request {
    Running running;
    std::string version;      ///< of etlc
    data::NamesInFile names;  ///< names of inputs and labels in data sets and arrays
};

/// Describes the encoders, without embeddings: their models and settings. Stores the settings of a
/// .json file beside a model in the model's encoders, and the library that runs them in the
/// request.
std::optional<embedded::File> describe_encoders(check::Model& model, Request& request,
                                                diag::Sink& sink);

/// Adds the embeddings of all images and videos that the spec names to the file.
bool embed_targets(const check::Model& model, const Request& request, embedded::File& file,
                   diag::Sink& sink);

/// Receives the bytes of each episode; reports an error and returns false where it cannot.
using Keep = std::function<bool(const Recording&, const std::string& bytes)>;

/// Makes an episode of each recording, with the encoded inputs and those that it has columns of.
bool embed_recordings(const check::Model& model, const embedded::File& file,
                      const std::vector<Recording>& recordings, const Request& request,
                      const Keep& keep, diag::Sink& sink);

}  // namespace etlc::embed
