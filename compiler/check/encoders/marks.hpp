// Whether the embeddings of an episode are by the spec's encoder.
// Takes: an input, and what the episode's file says of its arrays. Gives: why they are not. Keeps
// true: an array of which the file says nothing is taken as it is.
#pragma once

#include <optional>
#include <string>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embedded/embedded.hpp"

namespace etlc::check {

/// `array`: the name of the input in the file.
std::optional<diag::Failure> other_encoder(const Model& model, const Input& input,
                                           const std::string& array, const embedded::Marks& marks);

}  // namespace etlc::check
