// Frames of a recording as rows, frames("ep.npz", "z", [120, 180]).
// Takes: the words. Gives: the steps, and the samples there. Keeps true: a recording is taken only
// where the encoder of the input made its embeddings.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ast/ast.hpp"
#include "check/context/context.hpp"

namespace etlc::check {

/// Frames of a recording: samples of the embedding input whose name is the key.
std::optional<Matrix> read_frames(Context& context, const ast::Frames& frames);

/// The frames listed, or from the first to the last by the stride, in the order of the spec.
std::optional<std::vector<std::uint64_t>> frames_of(Context& context, const ast::Frames& frames);

}  // namespace etlc::check
