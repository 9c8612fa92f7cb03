// Decodes the pictures of a video in the order in which they are shown.
// Keeps true: a picture has the same pixels and number whether or not earlier ones were skipped;
// where time stamps are ambiguous, all pictures are decoded. A damaged or cut file ends the
// process.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace etlc::embed::worker {

/// Frees what FFmpeg allocated.
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

/// Describes an error of FFmpeg.
std::string words_of(int error);

/// Opens the decoder of the video in a source that `holds` or `sends` one. Returns its stream.
int open_codec(AVFormatContext* format, const std::string& holds, int threads, Codec& codec);

/// Returns whether a picture was decoded without a fault. `error`: of avcodec_receive_frame().
bool is_whole(int error, const AVFrame& picture);

/// Returns whether decoding may begin with a packet. Of packets ahead of such a one, decoders make
/// pictures with grey in place of what they refer to; that of H.264 leaves these out itself.
bool may_begin(const AVPacket& packet, const AVCodecParameters& codec);

class Decoder {
public:
    explicit Decoder(const std::string& path);

    const AVStream* stream() const { return format_->streams[stream_]; }

    /// Decodes the next picture; false at the end.
    bool next(AVFrame* picture);

    /// Skips to the last start before `frame` where that is ahead; see `shown`.
    void go_towards(std::int64_t frame);

    /// Returns the number of pictures that the container declares; 0 where it declares none.
    std::int64_t promised() const;
    /// Returns the number of pictures, where it is known without decoding them.
    std::optional<std::int64_t> counted();
    /// Returns the number of the next picture, counted from 0.
    std::int64_t shown() const { return shown_; }
    /// Returns the time stamp of the first picture, where pictures were skipped.
    std::int64_t first_time() const { return times_.empty() ? AV_NOPTS_VALUE : times_.front(); }

private:
    /// A picture where decoding may start.
    struct Start {
        std::int64_t shown = 0;  ///< time stamps of its packet
        std::int64_t decoded = 0;
    };

    void open(const std::string& path);
    void send();
    bool is_too_early();
    void check_whole();
    bool read_packet();
    void note_packets();
    void start_again();
    [[noreturn]] void damaged(int error) const;

    std::string path_;
    Format format_;
    Codec codec_;
    Packet packet_;
    std::deque<Packet> ahead_;  ///< packets behind `packet_` that were read already
    std::optional<bool> is_only_joined_;
    int stream_ = -1;
    std::int64_t shown_ = 0;
    std::int64_t discarded_ = 0;  ///< packets of pictures that are not shown
    std::int64_t discarded_in_all_ = 0;
    std::optional<std::int64_t> noted_;  ///< packets of pictures that are shown
    bool has_noted_ = false;
    bool has_jumped_ = false;
    bool has_begun_ = false;               ///< a packet was decoded since the last jump
    std::int64_t start_ = AV_NOPTS_VALUE;  ///< time of the picture to begin with; none: the first
    bool begins_with_start_ = true;        ///< the first packet is a start
    std::vector<std::int64_t> times_;      ///< times of all pictures, ascending; empty: ambiguous
    std::vector<Start> starts_;            ///< in the order of their times
};

}  // namespace etlc::embed::worker
