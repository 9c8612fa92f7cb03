// Frames in arrays, T x H x W x 3 of uint8, in .npz and .h5 files.
// Keeps true: only one frame is in memory; an array of another shape or element type is a failure
// (E08) that names it.
#pragma once

#include <memory>
#include <string>

#include "data/frames/frames.hpp"

namespace etlc::data {

/// Opens an array of FILE.npz, FILE.h5 or FILE.h5:GROUP; an empty name stands for the only array of
/// images. Failures do not repeat the path.
diag::Result<std::unique_ptr<FrameSource>> open_image_array(const std::string& path,
                                                            const std::string& name);

}  // namespace etlc::data
