// Image files.
// Takes: the path of an image, a folder or a pattern, relative to a folder. Gives: the images, each
// relative to that folder. Keeps true: they are sorted bytewise, whatever the file system or the
// locale.
#pragma once

#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// Whether the ending of a path is that of an image; capitals count as well.
bool is_image(const std::string& path);
/// ".png, .jpg or .jpeg"
std::string image_endings();

/// Failures are E1009, and do not repeat the path.
diag::Result<std::vector<std::string>> find_images(const std::string& folder,
                                                   const std::string& path);

}  // namespace etlc::data
