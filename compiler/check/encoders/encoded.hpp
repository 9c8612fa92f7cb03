// Images and frames that are the rows of targets. For `etlc embed` the model describes them; all
// other commands read their embeddings from the file that it wrote, if they were made by this
// encoder from these images.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// Whether the source is images(...), or frames(...) of a video.
bool is_encoded(const ast::Target::Source& source);

/// Reads the rows of such a source; nothing after an error.
std::optional<Matrix> read_encoded(Context& context, const ast::Target::Source& source,
                                   const std::optional<ast::Name>& encoder);

/// Returns the files of a source as named in the spec, sorted: an image, those in a folder or
/// matching a pattern, or a video.
diag::Result<std::vector<std::string>> files_of(const Encoded& encoded,
                                                const std::string& spec_path);

/// Reads frames of a recording: samples of the embedding input named by the key.
std::optional<Matrix> read_frames(Context& context, const ast::Frames& frames);

/// Returns the numbers of the frames in the order of the spec, with the stride expanded.
std::optional<std::vector<std::uint64_t>> frames_of(Context& context, const ast::Frames& frames);

}  // namespace etlc::check
