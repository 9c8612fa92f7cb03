// Decodes a source that goes on while it is watched: a camera, a stream, or a pipe.
// Every picture is sent as soon as it is decoded, behind the time of that moment; damaged ones are
// left out. A source that ends, ends the process; one that pauses does not.
#include <dlfcn.h>
#include <sys/stat.h>

#include <string>
#include <string_view>
#include <thread>

#include "embed/worker/pictures.hpp"
#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using recordings::frames::kRefused;

/// Protocols of addresses. None reads files of this machine, which a playlist could name.
constexpr const char* kProtocols =
    "rtsp,rtsps,rtp,udp,tcp,http,https,tls,crypto,rtmp,rtmps,srt,hls";
/// Damaged packets in a row, after which the source is given up.
constexpr int kMostDamaged = 500;

bool is_address(std::string_view source) {
    return source.find("://") != std::string_view::npos;
}

bool is_device(const std::string& source) {
    struct stat status {};
    return ::stat(source.c_str(), &status) == 0 && S_ISCHR(status.st_mode);
}

/// Returns what reads cameras. FFmpeg has it in a library of its own, which loads many others, so
/// only a camera loads it.
const AVInputFormat* camera_format() {
    const std::string name = "libavdevice.so." + std::to_string(LIBAVFORMAT_VERSION_MAJOR);
    void* const library = ::dlopen(name.c_str(), RTLD_NOW);
    const auto begin =
        library == nullptr
            ? nullptr
            : reinterpret_cast<void (*)()>(::dlsym(library, "avdevice_register_all"));
    if (begin == nullptr)
        refuse(kRefused, "is a camera, and " + name +
                             ", which reads cameras, cannot be loaded (Debian: libavdevice" +
                             std::to_string(LIBAVFORMAT_VERSION_MAJOR) + ")");
    begin();
    const AVInputFormat* const format = av_find_input_format("video4linux2,v4l2");
    if (format == nullptr) refuse(kRefused, "is a camera, and this FFmpeg reads no cameras");
    return format;
}

class Live {
public:
    explicit Live(const std::string& source) : packet_(av_packet_alloc()) {
        const bool camera = is_device(source);
        AVFormatContext* format = avformat_alloc_context();
        format->flags |= AVFMT_FLAG_NOBUFFER;
        AVDictionary* options = nullptr;
        if (!camera)
            av_dict_set(&options, "protocol_whitelist", is_address(source) ? kProtocols : "file",
                        0);
        const std::string place = camera || is_address(source) ? source : "file:" + source;
        int error = avformat_open_input(&format, place.c_str(), camera ? camera_format() : nullptr,
                                        &options);
        av_dict_free(&options);
        if (error < 0) refuse(kRefused, "cannot be opened as video: " + words_of(error));
        format_.reset(format);
        format->max_analyze_duration = AV_TIME_BASE / 2;
        error = avformat_find_stream_info(format, nullptr);
        if (error < 0) refuse(kRefused, "sends no video: " + words_of(error));
        // Threads that each decode a picture would hold several of them back.
        stream_ = open_codec(format, "sends", FF_THREAD_SLICE, codec_);
    }

    const AVStream* stream() const { return format_->streams[stream_]; }

    /// Decodes the next whole picture; false where the source has ended.
    bool next(AVFrame* picture) {
        for (;;) {
            const int error = avcodec_receive_frame(codec_.get(), picture);
            if (is_whole(error, *picture)) return true;
            if (error == AVERROR_EOF) return false;
            if (error != AVERROR(EAGAIN)) note_damage(error);
            if (error == AVERROR(EAGAIN)) send_packet();
        }
    }

private:
    void send_packet() {
        const int error = av_read_frame(format_.get(), packet_.get());
        if (error == AVERROR_EOF) {
            avcodec_send_packet(codec_.get(), nullptr);
            return;
        }
        if (error == AVERROR(EAGAIN)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            return;
        }
        if (error == AVERROR_INVALIDDATA) {
            note_damage(error);
            return;
        }
        if (error < 0) refuse(kRefused, "has stopped: " + words_of(error));
        const bool is_ours = packet_->stream_index == stream_;
        if (is_ours && !has_begun_) has_begun_ = may_begin(*packet_, *stream()->codecpar);
        if (is_ours && has_begun_) {
            const int sent = avcodec_send_packet(codec_.get(), packet_.get());
            if (sent < 0)
                note_damage(sent);
            else
                damaged_ = 0;
        }
        av_packet_unref(packet_.get());
    }

    void note_damage(int error) {
        if (++damaged_ > kMostDamaged)
            refuse(kRefused, "sends nothing that can be decoded: " + words_of(error));
    }

    Format format_;
    Codec codec_;
    Packet packet_;
    int stream_ = -1;
    bool has_begun_ = false;
    int damaged_ = 0;  ///< packets in a row
};

}  // namespace

void send_live(const std::string& source) {
    av_log_set_level(AV_LOG_QUIET);
    avformat_network_init();
    Live live(source);
    Converter converter;
    const int turns = quarter_turns(live.stream());
    const Picture picture(av_frame_alloc());
    for (std::int64_t frame = 0; live.next(picture.get()); ++frame) {
        write_stamp();
        send(*picture, converter, turns, frame);
    }
}

}  // namespace etlc::embed::worker
