// The pictures of a video, in the order in which they are shown.
// Takes: a file. Gives: one picture after the other; or from a later one on, without those before
// the key frame that it needs. Keeps true: a picture has the same pixels and number either way;
// where time stamps do not tell pictures apart, all are decoded. A file that is damaged or cut ends
// the process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "embed/worker/ffmpeg.hpp"

namespace etlc::embed::worker {

class Decoder {
public:
    explicit Decoder(const std::string& path);

    const AVStream* stream() const { return format_->streams[stream_]; }

    /// False at the end.
    bool next(AVFrame* picture);

    /// Goes on before `frame`, which `shown` then says is not far away; or stays where it is.
    void go_towards(std::int64_t frame);

    /// How many pictures there should be: what the container says; 0 where it says nothing.
    std::int64_t promised() const;
    /// How many there are, where that is known without decoding them.
    std::optional<std::int64_t> counted();
    /// The number of the next picture, counted from 0.
    std::int64_t shown() const { return shown_; }
    /// The time stamp of the first picture, where pictures before this one were left out.
    std::int64_t first_time() const { return times_.empty() ? AV_NOPTS_VALUE : times_.front(); }

private:
    void open(const std::string& path);
    void send();
    bool read_packet();
    void note_packets();
    void start_again();
    [[noreturn]] void damaged(int error) const;

    std::string path_;
    Format format_;
    Codec codec_;
    Packet packet_;
    int stream_ = -1;
    std::int64_t shown_ = 0;
    std::int64_t discarded_ = 0;  ///< packets of pictures that are not shown
    std::int64_t discarded_in_all_ = 0;
    std::optional<std::int64_t> noted_;  ///< packets of pictures that are shown
    bool has_noted_ = false;
    bool has_jumped_ = false;
    std::vector<std::int64_t> times_;   ///< of all pictures, ascending; empty: they do not tell
    std::vector<std::int64_t> starts_;  ///< of the key frames among them
};

}  // namespace etlc::embed::worker
