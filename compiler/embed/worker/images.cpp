// Images through OpenCV: PNG and JPEG, turned as their EXIF orientation says.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "data/frames/protocol.hpp"
#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

namespace {

using data::frames::kMaxExtent;
using data::frames::kMaxImageBytes;
using data::frames::kMaxPixels;
using data::frames::kRefused;
using data::frames::kWrongCall;
using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& path) {
    std::error_code error;
    const bool is_file = std::filesystem::is_regular_file(path, error);  // a pipe may never begin
    std::ifstream file(is_file ? path : "", std::ios::binary);
    if (!file) refuse(kRefused, "cannot be read as a file");
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

/// libjpeg fills what is not there with grey and only warns. The end is looked for behind the
/// segments of the head, since a thumbnail in them has an end of its own.
bool is_cut_jpeg(const Bytes& bytes) {
    constexpr std::uint8_t kMark = 0xff;
    constexpr std::uint8_t kScan = 0xda;
    constexpr std::uint8_t kEnd = 0xd9;
    if (bytes.size() < 4 || bytes[0] != kMark || bytes[1] != 0xd8) return false;
    std::size_t at = 2;
    while (at + 4 <= bytes.size() && bytes[at] == kMark && bytes[at + 1] != kScan)
        at += 2 + std::size_t{bytes[at + 2]} * 256 + bytes[at + 3];
    const std::uint8_t end[] = {kMark, kEnd};
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at, bytes.size()));
    return std::search(from, bytes.end(), std::begin(end), std::end(end)) == bytes.end();
}

/// Refuses what cannot be taken as red, green and blue of 8 bits without saying how.
void check_pixels(const cv::Mat& image) {
    if (image.depth() != CV_8U)
        refuse(kRefused, "has " + std::to_string(8 * image.elemSize1()) +
                             " bits a channel, expected 8: save it with 8");
    if (static_cast<std::uint32_t>(std::max(image.rows, image.cols)) > kMaxExtent ||
        image.total() > kMaxPixels)
        refuse(kRefused, "has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                             " pixels, more than are read");
    if (image.channels() != 4) return;
    cv::Mat alpha;
    cv::extractChannel(image, alpha, 3);
    double least = 0;
    cv::minMaxLoc(alpha, &least);
    if (least < 255) refuse(kRefused, "has transparent pixels, expected none: save it without");
}

void send_image(const Bytes& bytes) {
    if (bytes.empty()) refuse(kRefused, "is empty");
    if (is_cut_jpeg(bytes)) refuse(kRefused, "is cut: its end is missing");
    const cv::Mat stored = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    if (stored.empty()) refuse(kRefused, "is no image, or a damaged one");
    check_pixels(stored);
    const cv::Mat turned = cv::imdecode(bytes, cv::IMREAD_COLOR);
    if (turned.empty()) refuse(kRefused, "is no image, or a damaged one");
    cv::Mat rgb;
    cv::cvtColor(turned, rgb, cv::COLOR_BGR2RGB);
    write_frame(static_cast<std::uint32_t>(rgb.rows), static_cast<std::uint32_t>(rgb.cols),
                rgb.data);
}

}  // namespace

void send_images(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) send_image(bytes_of(path));
}

void send_given_images() {
    Bytes bytes;
    char head[4];
    while (read_in(head, sizeof head)) {
        const std::uint32_t size = data::frames::number_at(head);
        if (size > kMaxImageBytes)
            refuse(kRefused, "has " + std::to_string(size) + " bytes, at most " +
                                 std::to_string(kMaxImageBytes) + " are read");
        bytes.resize(size);
        if (size > 0 && !read_in(bytes.data(), size))
            refuse(kWrongCall, "standard input ends in an image");
        send_image(bytes);
    }
}

}  // namespace etlc::embed::worker
