// What `etlc embed` computes: embeddings of what a spec names, and episodes of recordings.
// Takes: the model of check_encoded. Gives: the file of embeddings; episodes, each as the bytes of
// an .npz archive. Keeps true: an encoder runs once for all that it encodes; what is wrong is
// reported, with the image, video or model that it is about.
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
    data::NamesInFile names;  ///< of inputs and labels in data sets and arrays
};

/// The encoders as they are now, without any embedding: their models and settings, those of a .json
/// beside a model among them, which the model's encoders get too, and what runs them, which the
/// request gets.
std::optional<embedded::File> describe_encoders(check::Model& model, Request& request,
                                                diag::Sink& sink);

/// Fills the file in with the embeddings of all that the spec names. False where it cannot.
bool embed_targets(const check::Model& model, const Request& request, embedded::File& file,
                   diag::Sink& sink);

/// Gets the bytes of each episode; false where they cannot be kept, which is reported.
using Keep = std::function<bool(const Recording&, const std::string& bytes)>;

/// Makes an episode of each recording: the inputs by encoders, and those that it has columns of.
/// False where it cannot.
bool embed_recordings(const check::Model& model, const embedded::File& file,
                      const std::vector<Recording>& recordings, const Request& request,
                      const Keep& keep, diag::Sink& sink);

}  // namespace etlc::embed
