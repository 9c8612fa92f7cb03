#include "embed/worker/pictures.hpp"

extern "C" {
#include <libavutil/display.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "embed/worker/prepare.hpp"
#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using namespace recordings::frames;

std::string size_text(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

const std::vector<std::uint8_t>& Converter::rgb(const AVFrame& picture, std::int64_t frame) {
    if (!scaler_) begin(picture);
    if (picture.width != width_ || picture.height != height_ || picture.format != format_)
        refuse(kRefused, "changes at frame " + std::to_string(frame) + " from " +
                             size_text(width_, height_) + " to " +
                             size_text(picture.width, picture.height) +
                             " or its pixels, expected one size");
    // Rows are padded to 64 bytes: the loops of the scaler skip the ends of others.
    std::uint8_t* const planes[] = {rows_.data()};
    const int strides[] = {stride_};
    sws_scale(scaler_.get(), picture.data, picture.linesize, 0, height_, planes, strides);
    const auto length = 3 * std::size_t(width_);
    for (std::size_t row = 0; row < std::size_t(height_); ++row)
        std::copy_n(rows_.data() + row * std::size_t(stride_), length, rgb_.data() + row * length);
    return rgb_;
}

void Converter::begin(const AVFrame& picture) {
    width_ = picture.width;
    height_ = picture.height;
    format_ = picture.format;
    if (width_ <= 0 || height_ <= 0 || std::max(width_, height_) > int{kMaxExtent} ||
        std::uint64_t(width_) * std::uint64_t(height_) > kMaxPixels)
        refuse(kRefused, "has frames of " + size_text(width_, height_) + ", more than are read");
    rgb_.resize(std::size_t(width_) * std::size_t(height_) * 3);
    stride_ = FFALIGN(3 * width_, 64) + 64;
    rows_.resize(std::size_t(stride_) * std::size_t(height_ + 1));
    scaler_.reset(sws_alloc_context());
    const AVPixFmtDescriptor* const pixels =
        av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format_));
    const bool half_rows = pixels != nullptr && pixels->log2_chroma_h == 1;
    const auto set = [this](const char* name, int value) {
        av_opt_set_int(scaler_.get(), name, value, 0);
    };
    set("srcw", width_);
    set("srch", height_);
    set("src_format", format_);
    set("dstw", width_);
    set("dsth", height_);
    set("dst_format", AV_PIX_FMT_RGB24);
    set("sws_flags", SWS_BICUBIC);
    if (half_rows) set("src_v_chr_pos", 128);
    if (sws_init_context(scaler_.get(), nullptr, nullptr) < 0)
        refuse(kRefused, "has pixels that cannot be made red, green and blue");
    set_colours(picture);
}

void Converter::set_colours(const AVFrame& picture) {
    const int* from = nullptr;
    int* to = nullptr;
    int full = 0, out_full = 0, brightness = 0, contrast = 0, saturation = 0;
    int* unused = nullptr;
    if (sws_getColorspaceDetails(scaler_.get(), &unused, &full, &to, &out_full, &brightness,
                                 &contrast, &saturation) < 0)
        return;  // RGB already
    const int space = picture.colorspace;
    const bool known = space >= 1 && space <= 10 && space != 8;
    from = sws_getCoefficients(known ? space : int{AVCOL_SPC_BT470BG});
    if (picture.color_range != AVCOL_RANGE_UNSPECIFIED)
        full = picture.color_range == AVCOL_RANGE_JPEG ? 1 : 0;
    sws_setColorspaceDetails(scaler_.get(), from, full, from, out_full, brightness, contrast,
                             saturation);
}

int quarter_turns(const AVStream* stream) {
    const auto* const matrix = reinterpret_cast<const std::int32_t*>(
        av_stream_get_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
    if (matrix == nullptr) return 0;
    const double angle = -av_display_rotation_get(matrix);
    return std::isnan(angle) ? 0 : (static_cast<int>(std::lround(angle / 90)) % 4 + 4) % 4;
}

void send(const AVFrame& picture, Converter& converter, int turns, std::int64_t frame) {
    const std::vector<std::uint8_t>& rgb = converter.rgb(picture, frame);
    if (turns == 0)
        return write_frame(std::uint32_t(picture.height), std::uint32_t(picture.width), rgb.data());
    Frame decoded(picture.height, picture.width);
    decoded.rgb = rgb;
    const Frame upright = turned(decoded, {.swaps = turns % 2 == 1,
                                           .from_bottom = turns == 1 || turns == 2,
                                           .from_right = turns >= 2});
    write_frame(std::uint32_t(upright.height), std::uint32_t(upright.width), upright.rgb.data());
}

namespace {

constexpr double kUsualSeconds = 1.0 / 25;  ///< of a frame, in a file that does not say
constexpr double kLongest = 60;             ///< seconds between two frames, whatever the file says

}  // namespace

void write_stamp() {
    using namespace std::chrono;
    const auto now = static_cast<std::uint64_t>(
        duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count());
    write_number(static_cast<std::uint32_t>(now));
    write_number(static_cast<std::uint32_t>(now >> 32U));
}

Pace::Pace(const AVStream* stream, bool real)
    : seconds_(av_q2d(stream->time_base)), frame_seconds_(kUsualSeconds), real_(real) {
    const double rate = av_q2d(stream->avg_frame_rate);
    if (rate > 0) frame_seconds_ = 1 / rate;
}

void Pace::stamp(const AVFrame& picture, std::int64_t frame) {
    using namespace std::chrono;
    if (!real_) return;
    const bool has_time = picture.best_effort_timestamp != AV_NOPTS_VALUE;
    const double time = has_time ? static_cast<double>(picture.best_effort_timestamp) * seconds_
                                 : static_cast<double>(frame) * frame_seconds_;
    const auto now = steady_clock::now();
    if (!begin_) {
        begin_ = now;
        first_ = time;
    }
    const auto due = *begin_ + duration_cast<nanoseconds>(duration<double>(time - first_));
    if (due > now && due - now < duration<double>(kLongest)) std::this_thread::sleep_until(due);
    write_stamp();
}

}  // namespace etlc::embed::worker
