// Encoders: the preprocessing of images before their models, from a spec, from a .json file beside
// the model or from a preprocessor_config.json, and whether embeddings in an episode were made by
// them. A setting is given once, or alike in all places; an episode that does not name its encoder
// causes a warning.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "artifacts/embedded.hpp"
#include "artifacts/json.hpp"
#include "check/model/model.hpp"
#include "diag/diag.hpp"

namespace etlc::check {

/// Sets one of the settings in docs/recordings.md, by its name. `word`: empty for those of numbers
/// alone. Returns an error message for an unsuitable word or numbers, or a contradiction.
std::optional<std::string> set_setting(Encoder& encoder, const std::string& key,
                                       const std::string& word,
                                       const std::vector<std::string>& numbers);

/// Returns "image [224, 224], mean [0.485, 0.456, 0.406], deviation [0.229, 0.224, 0.225]", with
/// neutral values for a missing mean or deviation, and without other settings that are missing.
std::string settings_text(const Encoder& encoder);

/// Reads a file of settings.
diag::Result<artifacts::Json> read_settings(const std::string& path);

/// Reads the settings in MODEL.json beside MODEL.onnx, if it exists.
std::optional<diag::Failure> take_settings_file(Encoder& encoder, const std::string& model_path);

/// Returns MODEL.json.
std::string settings_path(const std::string& model_path);

/// Describes the encoder as it is now: the hash of its model, and all settings, which `encoder`
/// gets too. The caller sets kind and dimension. A failure is about the file `place`.
diag::Result<embedded::Encoder> describe(Encoder& encoder, const std::string& spec_path,
                                         std::string& place);

/// Returns an error if the array was made by another encoder than the input's. `array` is the name
/// of the input in the file.
std::optional<diag::Failure> other_encoder(const Model& model, const Input& input,
                                           const std::string& array, const embedded::Marks& marks);

/// Whether the input has an encoder and the file does not name the encoder of the array.
bool is_unmarked(const Input& input, const std::string& array, const embedded::Marks& marks);
/// Adds notes to the warning about such an episode (W1001): its meaning, and how to keep the name.
void explain_unmarked(diag::Diagnostic& warning);

// The preprocessor_config.json that Hugging Face ships with a model, as settings of an encoder.
// Takes: the file. Gives: settings. Keeps true: a file that is accepted says all that is done to an
// image; a key that could change numbers and is not known is an error.

/// Sets what the image processor of transformers does: resizing, centre crop, mean and deviation.
/// Margins of the crop are rounded down, unless the spec says otherwise.
std::optional<diag::Failure> take_preprocessor(Encoder& encoder, const std::string& path);

}  // namespace etlc::check
