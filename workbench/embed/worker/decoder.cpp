#include "embed/worker/decoder.hpp"

#include <algorithm>
#include <cstdlib>

#include "data/frames/protocol.hpp"
#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

namespace {

using data::frames::kRefused;

/// Skipping fewer pictures than these is slower than decoding them.
constexpr std::int64_t kFewPictures = 50;

std::string words_of(int error) {
    char words[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(error, words, sizeof words);
    return words;
}

/// Returns whether every packet of such a video is one picture that is shown.
bool is_shown_by_packets(AVCodecID codec) {
    return codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_HEVC || codec == AV_CODEC_ID_AV1 ||
           codec == AV_CODEC_ID_VP9;
}

/// Returns the number of pictures that some programs declare in Matroska files.
std::int64_t promised_by_tag(const AVStream* stream) {
    const AVDictionaryEntry* tag =
        av_dict_get(stream->metadata, "NUMBER_OF_FRAMES", nullptr, AV_DICT_IGNORE_SUFFIX);
    return tag == nullptr ? 0 : std::strtoll(tag->value, nullptr, 10);
}

}  // namespace

Decoder::Decoder(const std::string& path) : path_(path), packet_(av_packet_alloc()) {
    open(path);
}

void Decoder::open(const std::string& path) {
    AVFormatContext* format = nullptr;
    AVDictionary* limits = nullptr;
    av_dict_set(&limits, "protocol_whitelist", "file", 0);  // a playlist may name other files
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

bool Decoder::next(AVFrame* picture) {
    for (;;) {
        const int error = avcodec_receive_frame(codec_.get(), picture);
        if (error == AVERROR(EAGAIN)) {
            send();
            continue;
        }
        const bool is_whole = error == 0 && (picture->flags & AV_FRAME_FLAG_CORRUPT) == 0 &&
                              picture->decode_error_flags == 0;
        if (has_jumped_) {
            const auto at = static_cast<std::size_t>(shown_);
            const bool has_time = is_whole && at < times_.size();
            // A picture shown before the key frame may need earlier packets.
            if (has_time && picture->best_effort_timestamp < times_[at]) continue;
            const bool is_expected = at < times_.size()
                                         ? has_time && picture->best_effort_timestamp == times_[at]
                                         : error == AVERROR_EOF;
            if (!is_expected) {
                start_again();
                continue;
            }
        }
        if (error == AVERROR_EOF) return false;
        if (error != 0) damaged(error);
        if (!is_whole)
            refuse(kRefused,
                   "is damaged: frame " + std::to_string(shown_) + " cannot be decoded whole");
        ++shown_;
        return true;
    }
}

void Decoder::go_towards(std::int64_t frame) {
    if (frame - shown_ < kFewPictures) return;
    note_packets();
    if (frame >= static_cast<std::int64_t>(times_.size())) return;
    const std::int64_t time = times_[static_cast<std::size_t>(frame)];
    const auto behind = std::upper_bound(starts_.begin(), starts_.end(), time);
    if (behind == starts_.begin()) return;
    const std::int64_t start = *std::prev(behind);
    const auto place = std::lower_bound(times_.begin(), times_.end(), start) - times_.begin();
    if (place - shown_ < kFewPictures) return;
    if (av_seek_frame(format_.get(), stream_, start, AVSEEK_FLAG_BACKWARD) < 0) return;
    avcodec_flush_buffers(codec_.get());
    shown_ = place;
    discarded_ = discarded_in_all_;
    has_jumped_ = true;
}

std::int64_t Decoder::promised() const {
    const std::int64_t frames =
        stream()->nb_frames > 0 ? stream()->nb_frames : promised_by_tag(stream());
    return std::max<std::int64_t>(frames - discarded_, 0);
}

std::optional<std::int64_t> Decoder::counted() {
    note_packets();
    if (noted_ || promised() == 0) return noted_;
    return promised();
}

/// False at the end.
bool Decoder::read_packet() {
    int error = av_read_frame(format_.get(), packet_.get());
    while (error == 0 && packet_->stream_index != stream_) {
        av_packet_unref(packet_.get());
        error = av_read_frame(format_.get(), packet_.get());
    }
    if (error == AVERROR_EOF) return false;
    if (error < 0) damaged(error);
    return true;
}

void Decoder::send() {
    if (!read_packet()) {
        avcodec_send_packet(codec_.get(), nullptr);
        return;
    }
    if ((packet_->flags & AV_PKT_FLAG_DISCARD) != 0 && !has_jumped_) ++discarded_;
    if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) damaged(AVERROR_INVALIDDATA);
    const int error = avcodec_send_packet(codec_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (error < 0) damaged(error);
}

/// Reads the time stamps of all packets once.
void Decoder::note_packets() {
    if (has_noted_) return;
    has_noted_ = true;
    if (!is_shown_by_packets(stream()->codecpar->codec_id)) return;
    Decoder other(path_);
    bool is_first = true;
    bool tells = true;
    for (; other.read_packet(); av_packet_unref(other.packet_.get())) {
        const AVPacket& packet = *other.packet_;
        if ((packet.flags & AV_PKT_FLAG_DISCARD) != 0) {
            ++discarded_in_all_;
            continue;
        }
        const bool is_key = (packet.flags & AV_PKT_FLAG_KEY) != 0;
        tells = tells && packet.pts != AV_NOPTS_VALUE && (is_key || !is_first);
        is_first = false;
        times_.push_back(packet.pts);
        if (is_key) starts_.push_back(packet.pts);
    }
    noted_ = static_cast<std::int64_t>(times_.size());
    const std::int64_t first = times_.empty() ? 0 : times_.front();
    std::sort(times_.begin(), times_.end());
    std::sort(starts_.begin(), starts_.end());
    tells = tells && !times_.empty() && times_.front() == first &&
            std::adjacent_find(times_.begin(), times_.end()) == times_.end();
    if (!tells) times_.clear();
}

/// Starts again and decodes everything up to the current picture: the pictures after a key frame
/// contradict their time stamps.
void Decoder::start_again() {
    const std::int64_t shown = shown_;
    times_.clear();
    has_jumped_ = false;
    shown_ = 0;
    discarded_ = 0;
    open(path_);
    const Picture passed(av_frame_alloc());
    while (shown_ < shown && next(passed.get())) {
    }
}

void Decoder::damaged(int error) const {
    refuse(kRefused,
           "is damaged or cut behind frame " + std::to_string(shown_) + ": " + words_of(error));
}

}  // namespace etlc::embed::worker
