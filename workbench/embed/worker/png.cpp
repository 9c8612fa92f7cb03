// Writes frames as PNG.
#include <png.h>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

using namespace recordings::frames;

void write_png() {
    char head[8];
    if (!read_in(head, sizeof head)) refuse(kWrongCall, "there is no frame on standard input");
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.height = number_at(head);
    image.width = number_at(head + 4);
    image.format = PNG_FORMAT_RGB;
    const std::uint64_t pixels = std::uint64_t{image.height} * image.width;
    if (pixels == 0 || pixels > kMaxPixels) refuse(kWrongCall, "the frame has no size to write");
    std::vector<std::uint8_t> rgb(3 * pixels);
    if (!read_in(rgb.data(), rgb.size())) refuse(kWrongCall, "standard input ends in a frame");
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::uint8_t> bytes(size);
    constexpr int kAsSrgb = 0;
    if (png_image_write_to_memory(&image, bytes.data(), &size, kAsSrgb, rgb.data(), 0, nullptr) ==
        0)
        refuse(kRefused, image.message);
    write_out(bytes.data(), size);
}

}  // namespace etlc::embed::worker
