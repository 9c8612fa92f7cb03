// FFmpeg's things, each freed with its holder.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <memory>

namespace etlc::embed::worker {

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

}  // namespace etlc::embed::worker
