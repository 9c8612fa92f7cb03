// Preprocessing of images before a model, from a spec or from a .json file beside the model. A
// setting is given once, or alike in both places.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "embedded/embedded.hpp"

namespace etlc::check {

/// Sets `image`, `mean` or `deviation`. Returns an error message for unsuitable numbers or a
/// contradiction.
std::optional<std::string> set_setting(Encoder& encoder, const std::string& key,
                                       const std::vector<std::string>& numbers);

/// Returns "image [224, 224], mean [0.485, 0.456, 0.406], deviation [0.229, 0.224, 0.225]", with
/// neutral values for missing settings.
std::string settings_text(const Encoder& encoder);

/// Reads the settings in MODEL.json beside MODEL.onnx, if it exists.
std::optional<diag::Failure> take_settings_file(Encoder& encoder, const std::string& model_path);

/// Returns MODEL.json.
std::string settings_path(const std::string& model_path);

/// Describes the encoder as it is now: the hash of its model, and all settings, which `encoder`
/// gets too. The caller sets kind and dimension. A failure is about the file `place`.
diag::Result<embedded::Encoder> describe(Encoder& encoder, const std::string& model_path,
                                         std::string& place);

}  // namespace etlc::check
