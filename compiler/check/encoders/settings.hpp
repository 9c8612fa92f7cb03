// What is done to an image before a model sees it, from a spec or from a .json beside the model.
// Takes: keys and decimal numbers. Gives: the settings, and their canonical text. Keeps true: a
// setting stands once; what the spec and the .json both say, they say alike.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "artifacts/embedded.hpp"

namespace etlc::check {

/// Sets `image`, `mean` or `deviation`; gives what is wrong with the numbers, or that the encoder
/// has it already with others.
std::optional<std::string> set_setting(Encoder& encoder, const std::string& key,
                                       const std::vector<std::string>& numbers);

/// "image [224, 224], mean [0.485, 0.456, 0.406], deviation [0.229, 0.224, 0.225]"; what is not
/// set is what does nothing.
std::string settings_text(const Encoder& encoder);

/// Takes the settings of MODEL.json beside MODEL.onnx, where it is there.
std::optional<diag::Failure> take_settings_file(Encoder& encoder, const std::string& model_path);

/// MODEL.json
std::string settings_path(const std::string& model_path);

/// The encoder as it is now: the hash of its model, and all settings, which `encoder` gets too. The
/// kind and the dimension are the caller's. Failures are about the file `place`.
diag::Result<embedded::Encoder> describe(Encoder& encoder, const std::string& model_path,
                                         std::string& place);

}  // namespace etlc::check
