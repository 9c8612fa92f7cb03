// Reference frames: pictures that etlc draws, the same in every version and on every machine. Two
// encoders are the same if they make the same embeddings of these.
// Keeps true: the pictures have detail at every scale, another mean for each colour and no
// symmetry, so that another crop, filter, flip or order of channels changes their embeddings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "data/frames/frames.hpp"

namespace etlc::data {

inline constexpr std::uint32_t kReferenceFrames = 4;
/// The relative difference up to which embeddings of a frame are by the same encoder.
inline constexpr double kSameEncoder = 1e-3;

/// Draws a frame of 480 x 640 pixels. `index`: below kReferenceFrames.
Frame reference_frame(std::uint32_t index);

/// Returns a source of all reference frames.
std::unique_ptr<FrameSource> reference_frames();

/// Returns |z - r| / |r|, or |z| where r is 0; infinity where it is not finite.
double relative_difference(const float* z, const float* r, std::size_t elements);

}  // namespace etlc::data
