// What targets are made of by an encoder: images, and frames of videos.
// Takes: the words of a target. Gives: the model's description of them, for `etlc embed`, and their
// embeddings from the file that it wrote, for all others. Keeps true: an embedding is taken only
// where it was made by this encoder, of these images.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// images(...), or frames(...) of a video.
bool is_encoded(const ast::Target::Source& source);

/// The rows of one of these; nothing, with a diagnostic, where there are none or had an error.
std::optional<Matrix> read_encoded(Context& context, const ast::Target::Source& source,
                                   const std::optional<ast::Name>& encoder);

/// Its files, as the spec names them, sorted; an image, those of a folder or pattern, or a video.
diag::Result<std::vector<std::string>> files_of(const Encoded& encoded,
                                                const std::string& spec_path);

/// Frames of a recording: samples of the embedding input whose name is the key.
std::optional<Matrix> read_frames(Context& context, const ast::Frames& frames);

/// The frames listed, or from the first to the last by the stride, in the order of the spec.
std::optional<std::vector<std::uint64_t>> frames_of(Context& context, const ast::Frames& frames);

}  // namespace etlc::check
