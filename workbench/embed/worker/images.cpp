// Decodes images with libpng and libjpeg, and applies their EXIF orientation.
#include <png.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

// These headers need the ones before them.
#include <jpeglib.h>

#include <jerror.h>

#include "embed/worker/prepare.hpp"
#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using recordings::frames::kMaxExtent;
using recordings::frames::kMaxImageBytes;
using recordings::frames::kMaxPixels;
using recordings::frames::kRefused;
using recordings::frames::kWrongCall;
using recordings::frames::number_at;
using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

constexpr std::size_t kRgb = kChannels;

struct Image {
    Frame frame;
    unsigned orientation = 1;  ///< EXIF orientation, 1 to 8
};

Bytes bytes_of(const std::string& path) {
    std::error_code error;
    const bool is_file = std::filesystem::is_regular_file(path, error);  // a pipe may block
    std::ifstream file(is_file ? path : "", std::ios::binary);
    if (!file) refuse(kRefused, "cannot be read as a file");
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

[[noreturn]] void refuse_damaged(const char* why) {
    refuse(kRefused, std::string("is damaged: ") + why);
}

[[noreturn]] void refuse_cut() {
    refuse(kRefused, "is cut: its end is missing");
}

/// Checks the size of an image before its pixels are allocated.
void check_size(std::uint64_t width, std::uint64_t height) {
    if (std::max(width, height) <= kMaxExtent && width * height <= kMaxPixels) return;
    refuse(kRefused, "has " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels, expected at most " + std::to_string(kMaxExtent) +
                         " in a row or column and " + std::to_string(kMaxPixels) + " in all");
}

/// Reads the orientation from EXIF data, a list of entries of 12 bytes; 1 where there is none.
unsigned orientation_in(View tiff) {
    constexpr std::uint64_t kOrientation = 0x0112, kShort = 3;
    const bool little = tiff.size() >= 2 && tiff[0] == 'I' && tiff[1] == 'I';
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::uint64_t result = 0;
        for (std::size_t i = 0; i < bytes && at + bytes <= tiff.size(); ++i)
            result = result << 8U | tiff[little ? at + bytes - 1 - i : at + i];
        return result;
    };
    if (number(2, 2) != 42) return 1;
    const std::size_t list = number(4, 4);
    for (std::size_t i = 0; i < number(list, 2); ++i) {
        const std::size_t entry = list + 2 + 12 * i;
        if (number(entry, 2) != kOrientation || number(entry + 2, 2) != kShort) continue;
        const std::uint64_t found = number(entry + 8, 2);
        return found >= 1 && found <= 8 ? static_cast<unsigned>(found) : 1;
    }
    return 1;
}

class Png {
public:
    explicit Png(View bytes) : rest_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
        info_ = png_create_info_struct(png_);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // check_size() reports more
        png_set_read_fn(png_, this, read);
    }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;
    ~Png() { png_destroy_read_struct(&png_, &info_, nullptr); }

    Image decoded() {
        png_read_info(png_, info_);
        const std::size_t height = png_get_image_height(png_, info_);
        const std::size_t width = png_get_image_width(png_, info_);
        check_size(width, height);
        if (png_get_bit_depth(png_, info_) == 16)
            refuse(kRefused, "has 16 bits a channel, expected 8: save it with 8");
        png_set_expand(png_);
        png_set_gray_to_rgb(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        const std::size_t channels = png_get_channels(png_, info_);
        Bytes pixels(height * width * channels);
        std::vector<png_bytep> rows(height);
        for (std::size_t row = 0; row < rows.size(); ++row)
            rows[row] = pixels.data() + row * width * channels;
        png_read_image(png_, rows.data());
        png_read_end(png_, info_);
        Image image;
        image.frame.height = static_cast<int>(height);
        image.frame.width = static_cast<int>(width);
        image.frame.rgb = opaque(std::move(pixels), channels);
        png_bytep exif = nullptr;
        png_uint_32 size = 0;
        if (png_get_eXIf_1(png_, info_, &size, &exif) != 0)
            image.orientation = orientation_in({exif, size});
        return image;
    }

private:
    [[noreturn]] static void fail(png_structp /*unused*/, const char* why) { refuse_damaged(why); }
    static void ignore(png_structp /*unused*/, const char* /*unused*/) {}

    static void read(png_structp png, png_bytep to, std::size_t size) {
        View& rest = static_cast<Png*>(png_get_io_ptr(png))->rest_;
        if (size > rest.size()) refuse_cut();
        std::copy_n(rest.begin(), size, to);
        rest = rest.subspan(size);
    }

    static Bytes opaque(Bytes pixels, std::size_t channels) {
        if (channels == kRgb) return pixels;
        std::size_t to = 0;
        for (std::size_t from = 0; from < pixels.size(); from += channels, to += kRgb) {
            if (pixels[from + kRgb] != 255)
                refuse(kRefused, "has transparent pixels, expected none: save it without");
            std::copy_n(pixels.begin() + std::ptrdiff_t(from), kRgb,
                        pixels.begin() + std::ptrdiff_t(to));
        }
        pixels.resize(to);
        return pixels;
    }

    View rest_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

class Jpeg {
public:
    explicit Jpeg(View bytes) {
        state_.err = jpeg_std_error(&errors_);
        errors_.error_exit = fail;
        errors_.emit_message = judge;
        jpeg_create_decompress(&state_);
        jpeg_mem_src(&state_, bytes.data(), bytes.size());
        jpeg_save_markers(&state_, kExif, 0xffff);
    }
    Jpeg(const Jpeg&) = delete;
    Jpeg& operator=(const Jpeg&) = delete;
    ~Jpeg() { jpeg_destroy_decompress(&state_); }

    Image decoded() {
        jpeg_read_header(&state_, TRUE);
        check_size(state_.image_width, state_.image_height);
        if (state_.jpeg_color_space == JCS_CMYK || state_.jpeg_color_space == JCS_YCCK)
            refuse(kRefused, "is made for printing (CMYK), expected grey or RGB");
        state_.out_color_space = JCS_RGB;
        Image image{{static_cast<int>(state_.image_height), static_cast<int>(state_.image_width)},
                    orientation()};
        jpeg_start_decompress(&state_);
        while (state_.output_scanline < state_.output_height) {
            JSAMPROW row = image.frame.row(static_cast<int>(state_.output_scanline));
            jpeg_read_scanlines(&state_, &row, 1);
        }
        jpeg_finish_decompress(&state_);
        return image;
    }

private:
    static constexpr int kExif = JPEG_APP0 + 1;

    unsigned orientation() const {
        constexpr char kName[] = {'E', 'x', 'i', 'f', '\0', '\0'};
        for (const jpeg_marker_struct* one = state_.marker_list; one != nullptr; one = one->next)
            if (one->data_length > sizeof kName && std::memcmp(one->data, kName, sizeof kName) == 0)
                return orientation_in({one->data + sizeof kName, one->data_length - sizeof kName});
        return 1;
    }

    [[noreturn]] static void fail(j_common_ptr state) {
        char why[JMSG_LENGTH_MAX];
        state->err->format_message(state, why);
        refuse_damaged(why);
    }

    /// Accepts only those warnings of the library that leave the pixels unchanged.
    static void judge(j_common_ptr state, int level) {
        const int code = state->err->msg_code;
        if (level >= 0 || code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR ||
            code == JWRN_NOT_SEQUENTIAL)
            return;
        if (code == JWRN_JPEG_EOF) refuse_cut();
        fail(state);
    }

    jpeg_decompress_struct state_{};
    jpeg_error_mgr errors_{};
};

/// Rotates and mirrors an image by its EXIF orientation.
Frame upright(Image image) {
    const unsigned kind = image.orientation;
    if (kind == 1) return std::move(image.frame);
    return turned(image.frame, {.swaps = kind >= 5,
                                .from_bottom = kind == 3 || kind == 4 || kind == 6 || kind == 7,
                                .from_right = kind == 2 || kind == 3 || kind == 7 || kind == 8});
}

void send_image(const Bytes& bytes) {
    if (bytes.empty()) refuse(kRefused, "is empty");
    const bool is_png = bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
    const bool is_jpeg = bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0xd8;
    if (!is_png && !is_jpeg) refuse(kRefused, "is no image, expected PNG or JPEG");
    const Frame frame = upright(is_png ? Png(bytes).decoded() : Jpeg(bytes).decoded());
    write_frame(static_cast<std::uint32_t>(frame.height), static_cast<std::uint32_t>(frame.width),
                frame.rgb.data());
}

}  // namespace

void send_images(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) send_image(bytes_of(path));
}

void send_given_images() {
    Bytes bytes;
    char head[4];
    while (read_in(head, sizeof head)) {
        const std::uint32_t size = recordings::frames::number_at(head);
        if (size > kMaxImageBytes)
            refuse(kRefused, "has " + std::to_string(size) + " bytes, at most " +
                                 std::to_string(kMaxImageBytes) + " are read");
        bytes.resize(size);
        if (size > 0 && !read_in(bytes.data(), size))
            refuse(kWrongCall, "standard input ends in an image");
        send_image(bytes);
    }
}

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
