// Checks whether the embeddings in an episode were made by the spec's encoder. An episode that does
// not name its encoder is accepted with a warning.
#pragma once

#include <optional>
#include <string>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embedded/embedded.hpp"

namespace etlc::check {

/// Returns an error if the array was made by another encoder than the input's. `array` is the name
/// of the input in the file.
std::optional<diag::Failure> other_encoder(const Model& model, const Input& input,
                                           const std::string& array, const embedded::Marks& marks);

/// Whether the input has an encoder and the file does not name the encoder of the array.
bool is_unmarked(const Input& input, const std::string& array, const embedded::Marks& marks);
/// Adds notes to the warning about such an episode (W1001): its meaning, and how to keep the name.
void explain_unmarked(diag::Diagnostic& warning);

}  // namespace etlc::check
