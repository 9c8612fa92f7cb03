// Frames that are arrays: T x H x W x 3 of uint8, in .npz and .h5 files.
// Takes: an archive, or a group of one, and the name of the array. Gives: its frames. Keeps true:
// memory is that of one frame; an array of another shape or of other elements is a failure (E08)
// that names it.
#pragma once

#include <memory>
#include <string>

#include "data/frames/frames.hpp"

namespace etlc::data {

/// `path`: FILE.npz, FILE.h5 or FILE.h5:GROUP. `name`: of the array; empty: the only one that holds
/// images. Failures do not repeat the path.
diag::Result<std::unique_ptr<FrameSource>> open_image_array(const std::string& path,
                                                            const std::string& name);

}  // namespace etlc::data
