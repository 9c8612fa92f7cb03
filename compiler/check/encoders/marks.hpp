// Whether the embeddings of an episode are by the spec's encoder.
// Takes: an input, and what the episode's file says of its arrays. Gives: why they are not, or that
// the file does not say. Keeps true: an array of which it says nothing is taken, with a warning.
#pragma once

#include <optional>
#include <string>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "artifacts/embedded.hpp"

namespace etlc::check {

/// `array`: the name of the input in the file.
std::optional<diag::Failure> other_encoder(const Model& model, const Input& input,
                                           const std::string& array, const embedded::Marks& marks);

/// Whether an input is by an encoder and the file does not say by which.
bool is_unmarked(const Input& input, const std::string& array, const embedded::Marks& marks);
/// What a warning of such an episode (W1001) means, and how to keep what it lacks.
void explain_unmarked(diag::Diagnostic& warning);

}  // namespace etlc::check
