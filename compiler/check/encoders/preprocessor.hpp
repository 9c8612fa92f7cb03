// The preprocessor_config.json that Hugging Face ships with a model, as settings of an encoder.
// Takes: the file. Gives: settings. Keeps true: a file that is accepted says all that is done to an
// image; a key that could change numbers and is not known is an error.
#pragma once

#include <optional>
#include <string>

#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

/// Sets what the image processor of transformers does: resizing, centre crop, mean and deviation.
/// Margins of the crop are rounded down, unless the spec says otherwise.
std::optional<diag::Failure> take_preprocessor(Encoder& encoder, const std::string& path);

}  // namespace etlc::check
