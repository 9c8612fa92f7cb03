// Video through FFmpeg's libraries. Frames have the bytes of
// `ffmpeg -i FILE -fps_mode passthrough -f rawvideo -pix_fmt rgb24 -`.
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "data/frames/protocol.hpp"
#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

namespace {

using namespace data::frames;

template <auto free>
struct Free {
    template <class T>
    void operator()(T* pointer) const {
        free(&pointer);
    }
};
using Format = std::unique_ptr<AVFormatContext, Free<avformat_close_input>>;
using Codec = std::unique_ptr<AVCodecContext, Free<avcodec_free_context>>;
using Packet = std::unique_ptr<AVPacket, Free<av_packet_free>>;
using Picture = std::unique_ptr<AVFrame, Free<av_frame_free>>;
struct FreeScaler {
    void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
using Scaler = std::unique_ptr<SwsContext, FreeScaler>;

std::string words_of(int error) {
    char words[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(error, words, sizeof words);
    return words;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

/// Which frames are wanted.
struct Choice {
    std::vector<std::int64_t> only;
    std::int64_t first = 0;
    std::int64_t count = INT64_MAX;
    double rate = 0;

    /// One that needs no frame behind this one.
    bool ends_before(std::int64_t frame) const {
        if (!only.empty()) return frame > only.back();
        return frame >= first && frame - first >= count;
    }
    bool takes(std::int64_t frame, std::int64_t stride) const {
        if (!only.empty()) return std::binary_search(only.begin(), only.end(), frame);
        return frame >= first && !ends_before(frame) && (frame - first) % stride == 0;
    }
    bool is_all() const { return only.empty() && count == INT64_MAX; }
};

Choice choice_of(const Words& options) {
    const auto whole = [](double value) { return static_cast<std::int64_t>(value); };
    Choice choice;
    for (const double frame : options.numbers("--only")) choice.only.push_back(whole(frame));
    for (const double frame : options.numbers("--first")) choice.first = whole(frame);
    for (const double frames : options.numbers("--count")) choice.count = whole(frames);
    for (const double rate : options.numbers("--rate")) choice.rate = rate;
    return choice;
}

/// The pictures of the file's video, in the order in which they are shown.
class Decoder {
public:
    explicit Decoder(const std::string& path) : packet_(av_packet_alloc()) {
        AVFormatContext* format = nullptr;
        AVDictionary* limits = nullptr;
        av_dict_set(&limits, "protocol_whitelist", "file", 0);  // a play list may name others
        int error = avformat_open_input(&format, path.c_str(), nullptr, &limits);
        av_dict_free(&limits);
        if (error < 0) refuse(kRefused, "is no video, or a damaged one: " + words_of(error));
        format_.reset(format);
        error = avformat_find_stream_info(format, nullptr);
        if (error < 0) refuse(kRefused, "is no video, or a damaged one: " + words_of(error));
        const AVCodec* codec = nullptr;
        stream_ = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
        if (stream_ < 0 || codec == nullptr) refuse(kRefused, "holds no video that can be decoded");
        for (unsigned i = 0; i < format->nb_streams; ++i)
            if (static_cast<int>(i) != stream_) format->streams[i]->discard = AVDISCARD_ALL;
        codec_.reset(avcodec_alloc_context3(codec));
        avcodec_parameters_to_context(codec_.get(), stream()->codecpar);
        codec_->thread_count = 0;
        codec_->pkt_timebase = stream()->time_base;
        error = avcodec_open2(codec_.get(), codec, nullptr);
        if (error < 0) refuse(kRefused, "cannot be decoded: " + words_of(error));
    }

    const AVStream* stream() const { return format_->streams[stream_]; }

    /// False at the end.
    bool next(AVFrame* picture) {
        for (;;) {
            const int error = avcodec_receive_frame(codec_.get(), picture);
            if (error == 0) break;
            if (error == AVERROR_EOF) return false;
            if (error != AVERROR(EAGAIN)) damaged(error);
            send();
        }
        if ((picture->flags & AV_FRAME_FLAG_CORRUPT) != 0 || picture->decode_error_flags != 0)
            refuse(kRefused,
                   "is damaged: frame " + std::to_string(shown_) + " cannot be decoded whole");
        ++shown_;
        return true;
    }

    /// How many pictures there should be: what the container says; 0 where it says nothing.
    std::int64_t promised() const {
        return std::max<std::int64_t>(stream()->nb_frames - discarded_, 0);
    }
    std::int64_t shown() const { return shown_; }

private:
    void send() {
        int error = av_read_frame(format_.get(), packet_.get());
        while (error == 0 && packet_->stream_index != stream_) {
            av_packet_unref(packet_.get());
            error = av_read_frame(format_.get(), packet_.get());
        }
        if (error == AVERROR_EOF) {
            avcodec_send_packet(codec_.get(), nullptr);
            return;
        }
        if (error < 0) damaged(error);
        if ((packet_->flags & AV_PKT_FLAG_DISCARD) != 0) ++discarded_;
        if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) damaged(AVERROR_INVALIDDATA);
        error = avcodec_send_packet(codec_.get(), packet_.get());
        av_packet_unref(packet_.get());
        if (error < 0) damaged(error);
    }

    [[noreturn]] void damaged(int error) {
        refuse(kRefused,
               "is damaged or cut behind frame " + std::to_string(shown_) + ": " + words_of(error));
    }

    Format format_;
    Codec codec_;
    Packet packet_;
    int stream_ = -1;
    std::int64_t shown_ = 0;
    std::int64_t discarded_ = 0;
};

/// To red, green and blue as ffmpeg converts by default.
class Converter {
public:
    const std::vector<std::uint8_t>& rgb(const AVFrame& picture, std::int64_t frame) {
        if (!scaler_) begin(picture);
        if (picture.width != width_ || picture.height != height_ || picture.format != format_)
            refuse(kRefused, "changes at frame " + std::to_string(frame) + " from " +
                                 size_text(width_, height_) + " to " +
                                 size_text(picture.width, picture.height) +
                                 " or its pixels, expected one size");
        // Rows that end on a boundary of 64 bytes: the scaler's loops leave out the ends of others.
        std::uint8_t* const planes[] = {rows_.data()};
        const int strides[] = {stride_};
        sws_scale(scaler_.get(), picture.data, picture.linesize, 0, height_, planes, strides);
        const auto length = 3 * std::size_t(width_);
        for (std::size_t row = 0; row < std::size_t(height_); ++row)
            std::copy_n(rows_.data() + row * std::size_t(stride_), length,
                        rgb_.data() + row * length);
        return rgb_;
    }

private:
    static std::string size_text(int width, int height) {
        return std::to_string(width) + " x " + std::to_string(height);
    }

    void begin(const AVFrame& picture) {
        width_ = picture.width;
        height_ = picture.height;
        format_ = picture.format;
        if (width_ <= 0 || height_ <= 0 || std::max(width_, height_) > int{kMaxExtent} ||
            std::uint64_t(width_) * std::uint64_t(height_) > kMaxPixels)
            refuse(kRefused,
                   "has frames of " + size_text(width_, height_) + ", more than are read");
        rgb_.resize(std::size_t(width_) * std::size_t(height_) * 3);
        stride_ = FFALIGN(3 * width_, 64) + 64;
        rows_.resize(std::size_t(stride_) * std::size_t(height_ + 1));
        scaler_.reset(sws_alloc_context());
        const AVPixFmtDescriptor* const pixels =
            av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format_));
        const bool half_rows = pixels != nullptr && pixels->log2_chroma_h == 1;
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

    void set(const char* name, int value) { av_opt_set_int(scaler_.get(), name, value, 0); }

    void set_colours(const AVFrame& picture) {
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

    Scaler scaler_;
    int width_ = 0;
    int height_ = 0;
    int format_ = -1;
    int stride_ = 0;
    std::vector<std::uint8_t> rows_;
    std::vector<std::uint8_t> rgb_;
};

/// Quarter turns clockwise that the file asks for, as cameras of phones write it.
int quarter_turns(const AVStream* stream) {
    const auto* const matrix = reinterpret_cast<const std::int32_t*>(
        av_stream_get_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
    if (matrix == nullptr) return 0;
    const double angle = -av_display_rotation_get(matrix);
    return std::isnan(angle) ? 0 : (static_cast<int>(std::lround(angle / 90)) % 4 + 4) % 4;
}

/// One quarter turn clockwise; swaps height and width.
void turn(std::vector<std::uint8_t>& rgb, int& height, int& width) {
    std::vector<std::uint8_t> turned(rgb.size());
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const auto from = 3 * (std::size_t(row) * std::size_t(width) + std::size_t(column));
            const auto to =
                3 * (std::size_t(column) * std::size_t(height) + std::size_t(height - 1 - row));
            std::copy_n(rgb.begin() + std::ptrdiff_t(from), 3, turned.begin() + std::ptrdiff_t(to));
        }
    rgb.swap(turned);
    std::swap(height, width);
}

void send(const AVFrame& picture, Converter& converter, int turns, std::int64_t frame) {
    const std::vector<std::uint8_t>& rgb = converter.rgb(picture, frame);
    int height = picture.height;
    int width = picture.width;
    if (turns == 0) {
        write_frame(std::uint32_t(height), std::uint32_t(width), rgb.data());
        return;
    }
    std::vector<std::uint8_t> turned = rgb;
    for (int i = 0; i < turns; ++i) turn(turned, height, width);
    write_frame(std::uint32_t(height), std::uint32_t(width), turned.data());
}

/// Holds frames to the rate of the steps.
class Clock {
public:
    Clock(const AVStream* stream, double rate) : seconds_(av_q2d(stream->time_base)), rate_(rate) {
        if (rate == 0) return;
        frames_a_second_ = av_q2d(stream->avg_frame_rate);
        if (!(frames_a_second_ > 0))
            refuse(kOutOfStep,
                   "does not say how many frames it has a second, and the spec has a "
                   "rate");
        const double frames_a_step = frames_a_second_ / rate;
        stride_ = std::llround(frames_a_step);
        constexpr double kTolerance = 0.005;  // 29.97 frames a second are 30
        if (stride_ < 1 || std::abs(frames_a_step / double(stride_) - 1) > kTolerance)
            refuse(kOutOfStep, "has " + number(frames_a_second_) +
                                   " frames a second, expected a multiple of the " + number(rate) +
                                   " steps of the spec");
    }

    std::int64_t stride() const { return stride_; }

    /// Refuses a frame that is more than half a frame from its place.
    void check(const AVFrame& picture, std::int64_t frame) {
        if (rate_ == 0 || picture.best_effort_timestamp == AV_NOPTS_VALUE) return;
        const double time = double(picture.best_effort_timestamp) * seconds_;
        if (frame == 0) begin_ = time;
        const double place = double(frame) / frames_a_second_;
        if (std::abs(time - begin_ - place) * frames_a_second_ > 0.5)
            refuse(kOutOfStep, "has frame " + std::to_string(frame) + " at " +
                                   number(time - begin_) + " s, expected it at " + number(place) +
                                   " s: its frames are not evenly spaced");
    }

private:
    double seconds_;  ///< of a unit of time stamps
    double rate_;
    double frames_a_second_ = 0;
    double begin_ = 0;
    std::int64_t stride_ = 1;
};

void check_count(const Decoder& decoder, const Choice& choice) {
    const std::int64_t shown = decoder.shown();
    if (shown == 0) refuse(kRefused, "holds no frame, expected at least one");
    const std::int64_t last = choice.only.empty() ? choice.first : choice.only.back();
    const bool too_few = choice.only.empty() && !choice.is_all() && shown - last < choice.count;
    if (shown <= last || too_few)
        refuse(kNoSuchFrame, "has " + std::to_string(shown) + " frames; there is no frame " +
                                 std::to_string(too_few ? last + choice.count - 1 : last) +
                                 " (from 0)");
    if (decoder.promised() > 0 && decoder.promised() != shown)
        refuse(kRefused, "promises " + std::to_string(decoder.promised()) + " frames and holds " +
                             std::to_string(shown) + ": it is cut or damaged");
}

}  // namespace

void send_video(const std::string& path, const Words& options) {
    av_log_set_level(AV_LOG_QUIET);
    const Choice choice = choice_of(options);
    Decoder decoder("file:" + path);
    Clock clock(decoder.stream(), choice.rate);
    Converter converter;
    const int turns = quarter_turns(decoder.stream());
    const Picture picture(av_frame_alloc());
    for (std::int64_t frame = 0; !choice.ends_before(frame); ++frame) {
        if (!decoder.next(picture.get())) {
            check_count(decoder, choice);
            return;
        }
        clock.check(*picture, frame);
        if (choice.takes(frame, clock.stride())) send(*picture, converter, turns, frame);
    }
}

}  // namespace etlc::embed::worker
