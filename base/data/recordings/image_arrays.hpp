// Frames in arrays, T x H x W x 3 of uint8, or T x H x W of grey, in .npz and .h5 files.
// Keeps true: only one frame is in memory; an array of another shape or element type is a failure
// (E08) that names it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "data/frames/frames.hpp"

namespace etlc::data {

/// Grey images may be shown, but an encoder that was made for colours gets none.
enum class Grey : std::uint8_t { refused, taken };

/// Opens an array of FILE.npz, FILE.h5 or FILE.h5:GROUP; an empty name stands for the only array of
/// images in colour. Failures do not repeat the path.
diag::Result<std::unique_ptr<FrameSource>> open_image_array(const std::string& path,
                                                            const std::string& name,
                                                            Grey grey = Grey::refused);

}  // namespace etlc::data
