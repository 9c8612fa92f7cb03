// Camera images for web pages.
// Takes: a grey image. Gives: a data: address that holds it as a PNG (uncompressed deflate blocks,
// RFC 1951, section 3.2.4).
#pragma once

#include <string>

#include "camera.hpp"

namespace demo {

std::string png_address(const Image& image);

}  // namespace demo
