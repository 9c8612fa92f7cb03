#include "embed/worker/decoder.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <span>

#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using recordings::frames::kRefused;

/// Skipping fewer pictures than these is slower than decoding them.
constexpr std::int64_t kFewPictures = 50;

/// Returns whether every packet of such a video is one picture that is shown.
bool is_shown_by_packets(AVCodecID codec) {
    return codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_HEVC || codec == AV_CODEC_ID_AV1 ||
           codec == AV_CODEC_ID_VP9;
}

using Bytes = std::span<const std::uint8_t>;

/// The content of a packet, by its units in H.264 (ITU-T H.264, table 7-1) and HEVC (H.265, 7-1).
struct Content {
    bool is_start = false;   ///< decoding may start here, if pictures shown before are left out
    bool is_closed = false;  ///< a start behind which nothing refers to pictures before it
    bool has_parameters = false;  ///< parameters that later pictures may need
};

void note_unit(std::uint8_t head, bool is_hevc, Content& content) {
    const int type = is_hevc ? head >> 1 & 0x3f : head & 0x1f;
    if (is_hevc) {
        content.is_closed = content.is_closed || (type >= 16 && type <= 20);     // IDR, BLA
        content.is_start = content.is_closed || content.is_start || type == 21;  // CRA
        content.has_parameters = content.has_parameters || (type >= 32 && type <= 34);
    } else {
        content.is_closed = content.is_closed || type == 5;  // IDR
        content.is_start = content.is_closed;
        content.has_parameters = content.has_parameters || type == 7 || type == 8;
    }
}

/// Returns how many bytes the length in front of each unit has; 0 where start codes separate units.
std::size_t bytes_of_length(Bytes configuration, bool is_hevc) {
    const std::size_t at = is_hevc ? 21 : 4;
    if (configuration.size() <= at) return 0;
    const bool has_start_code = configuration[0] == 0 && configuration[1] == 0;
    return has_start_code ? 0 : (configuration[at] & 3U) + 1U;
}

Content content_of_units(Bytes packet, const AVCodecParameters& codec) {
    const bool is_hevc = codec.codec_id == AV_CODEC_ID_HEVC;
    const std::size_t prefix =
        bytes_of_length({codec.extradata, static_cast<std::size_t>(codec.extradata_size)}, is_hevc);
    Content content;
    if (prefix == 0) {
        for (std::size_t i = 0; i + 3 < packet.size(); ++i)
            if (packet[i] == 0 && packet[i + 1] == 0 && packet[i + 2] == 1)
                note_unit(packet[i + 3], is_hevc, content);
        return content;
    }
    while (packet.size() > prefix) {
        std::size_t length = 0;
        for (const std::uint8_t byte : packet.first(prefix)) length = length << 8U | byte;
        packet = packet.subspan(prefix);
        if (length == 0 || length > packet.size()) break;
        note_unit(packet[0], is_hevc, content);
        packet = packet.subspan(length);
    }
    return content;
}

/// Containers also mark pictures as key frames from which an H.264 decoder recovers by and by
/// (intra refresh), after as many pictures as the encoder says: some say too few.
Content content_of(const AVPacket& packet, const AVCodecParameters& codec) {
    if (codec.codec_id == AV_CODEC_ID_H264 || codec.codec_id == AV_CODEC_ID_HEVC)
        return content_of_units({packet.data, static_cast<std::size_t>(packet.size)}, codec);
    return {.is_start = (packet.flags & AV_PKT_FLAG_KEY) != 0};
}

/// Returns whether a transport stream (ISO/IEC 13818-1, 2.4.3) lacks no packets: their counters
/// only jump where another stream was joined. There all begin again with 0, those of tables first,
/// each with a new unit. Lost packets are followed by data before the next table.
bool is_only_joined(const std::string& path) {
    constexpr std::size_t kBytes = 188;
    constexpr int kTables = 0x20, kNothing = 0x1fff;
    struct Counter {
        int value = -1;
        int part = 0;  ///< of the file, in which it was seen last
    };
    std::map<int, Counter> counters;
    std::array<unsigned char, kBytes> packet{};
    std::ifstream file(path, std::ios::binary);
    for (int part = 0; file.read(reinterpret_cast<char*>(packet.data()), kBytes);) {
        if (packet[0] != 0x47) return false;
        const int id = (packet[1] & 0x1f) << 8 | packet[2];
        const int value = packet[3] & 0xf;
        const bool has_payload = (packet[3] & 0x10) != 0;
        const bool is_announced = (packet[3] & 0x20) != 0 && packet[4] > 0 && packet[5] >= 0x80;
        if (id == kNothing || !has_payload) continue;
        Counter& counter = counters.try_emplace(id, Counter{-1, part}).first->second;
        const bool goes_on = counter.value < 0 || value == counter.value || is_announced ||
                             value == (counter.value + 1) % 16;
        if (!goes_on) {
            if (id < kTables && counter.part == part) ++part;
            const bool begins_unit = (packet[1] & 0x40) != 0;
            if (counter.part == part || value != 0 || !begins_unit) return false;
        }
        counter = {value, part};
    }
    return true;
}

/// Returns the number of pictures that some programs declare in Matroska files.
std::int64_t promised_by_tag(const AVStream* stream) {
    const AVDictionaryEntry* tag =
        av_dict_get(stream->metadata, "NUMBER_OF_FRAMES", nullptr, AV_DICT_IGNORE_SUFFIX);
    return tag == nullptr ? 0 : std::strtoll(tag->value, nullptr, 10);
}

}  // namespace

std::string words_of(int error) {
    char words[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(error, words, sizeof words);
    return words;
}

int open_codec(AVFormatContext* format, const std::string& holds, int threads, Codec& codec) {
    const AVCodec* found = nullptr;
    const int stream = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &found, 0);
    if (stream < 0 || found == nullptr) refuse(kRefused, holds + " no video that can be decoded");
    codec.reset(avcodec_alloc_context3(found));
    avcodec_parameters_to_context(codec.get(), format->streams[stream]->codecpar);
    codec->thread_type = threads;
    codec->thread_count = 0;
    codec->pkt_timebase = format->streams[stream]->time_base;
    const int error = avcodec_open2(codec.get(), found, nullptr);
    if (error < 0) refuse(kRefused, "cannot be decoded: " + words_of(error));
    return stream;
}

bool is_whole(int error, const AVFrame& picture) {
    return error == 0 && (picture.flags & AV_FRAME_FLAG_CORRUPT) == 0 &&
           picture.decode_error_flags == 0;
}

bool may_begin(const AVPacket& packet, const AVCodecParameters& codec) {
    return codec.codec_id == AV_CODEC_ID_H264 || content_of(packet, codec).is_start;
}

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
    stream_ = open_codec(format, "holds", FF_THREAD_FRAME | FF_THREAD_SLICE, codec_);
    for (unsigned i = 0; i < format->nb_streams; ++i)
        if (static_cast<int>(i) != stream_) format->streams[i]->discard = AVDISCARD_ALL;
}

bool Decoder::next(AVFrame* picture) {
    for (;;) {
        const int error = avcodec_receive_frame(codec_.get(), picture);
        if (error == AVERROR(EAGAIN)) {
            send();
            continue;
        }
        const bool whole = is_whole(error, *picture);
        if (has_jumped_) {
            const auto at = static_cast<std::size_t>(shown_);
            const bool has_time = whole && at < times_.size();
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
        if (!whole)
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
    const auto behind =
        std::upper_bound(starts_.begin(), starts_.end(), time,
                         [](std::int64_t t, const Start& start) { return t < start.shown; });
    if (behind == starts_.begin()) return;
    const Start& start = *std::prev(behind);
    const auto place = std::lower_bound(times_.begin(), times_.end(), start.shown) - times_.begin();
    if (place - shown_ < kFewPictures) return;
    if (av_seek_frame(format_.get(), stream_, start.decoded, AVSEEK_FLAG_BACKWARD) < 0) return;
    avcodec_flush_buffers(codec_.get());
    ahead_.clear();
    start_ = start.shown;
    has_begun_ = false;
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
    if (!begins_with_start_) return std::nullopt;
    if (noted_ || promised() == 0) return noted_;
    return promised();
}

/// False at the end.
bool Decoder::read_packet() {
    if (!ahead_.empty()) {
        packet_ = std::move(ahead_.front());
        ahead_.pop_front();
        return true;
    }
    int error = av_read_frame(format_.get(), packet_.get());
    while (error == 0 && packet_->stream_index != stream_) {
        av_packet_unref(packet_.get());
        error = av_read_frame(format_.get(), packet_.get());
    }
    if (error == AVERROR_EOF) return false;
    if (error < 0) damaged(error);
    return true;
}

/// Refuses a picture of which packets of a transport stream were lost. Where two streams were
/// joined, the packets are numbered from 0 again, and FFmpeg takes the last picture of the first
/// one, or the picture before, for such a picture. What follows may not refer to it, and no time
/// may be missing there.
void Decoder::check_whole() {
    if (!is_only_joined_) is_only_joined_ = is_only_joined(path_.substr(path_.find(':') + 1));
    if (!*is_only_joined_) damaged(AVERROR_INVALIDDATA);
    std::deque<Packet> packets;
    packets.push_back(std::move(packet_));
    bool is_joined = false;
    for (int i = 0; i < 2 && !is_joined; ++i) {
        packet_.reset(av_packet_alloc());
        if (!read_packet()) break;
        const AVPacket& last = *packets.back();
        is_joined = content_of(*packet_, *stream()->codecpar).is_closed &&
                    last.dts != AV_NOPTS_VALUE && packet_->dts != AV_NOPTS_VALUE &&
                    packet_->dts <= last.dts + last.duration + last.duration / 2;
        packets.push_back(std::move(packet_));
    }
    if (!is_joined) damaged(AVERROR_INVALIDDATA);
    packet_ = std::move(packets.front());
    packets.pop_front();
    ahead_ = std::move(packets);
}

/// Returns whether the packet is ahead of the first one to decode.
bool Decoder::is_too_early() {
    if (has_begun_) return false;
    const bool is_first = start_ == AV_NOPTS_VALUE;
    has_begun_ = is_first ? may_begin(*packet_, *stream()->codecpar) : packet_->pts == start_;
    if (!has_begun_ && is_first && promised() > 0)
        refuse(kRefused, "is cut: its first frame refers to frames before it");
    return !has_begun_;
}

void Decoder::send() {
    if (!read_packet()) {
        avcodec_send_packet(codec_.get(), nullptr);
        return;
    }
    if (is_too_early()) {
        av_packet_unref(packet_.get());
        return;
    }
    if ((packet_->flags & AV_PKT_FLAG_DISCARD) != 0 && !has_jumped_) ++discarded_;
    if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) check_whole();
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
    bool tells = true;
    std::size_t with_parameters = 0;  // starts but the first
    std::int64_t last = AV_NOPTS_VALUE;
    for (bool is_first = true; other.read_packet(); av_packet_unref(other.packet_.get())) {
        const AVPacket& packet = *other.packet_;
        const Content content = content_of(packet, *stream()->codecpar);
        if (is_first) begins_with_start_ = content.is_start;
        const bool changes =
            (content.has_parameters && !content.is_start) ||
            av_packet_get_side_data(&packet, AV_PKT_DATA_NEW_EXTRADATA, nullptr) != nullptr;
        const bool goes_back = packet.dts != AV_NOPTS_VALUE && packet.dts <= last;
        last = std::max(last, packet.dts);
        tells = tells && packet.pts != AV_NOPTS_VALUE && !changes && !goes_back &&
                (packet.flags & AV_PKT_FLAG_CORRUPT) == 0;
        if (content.is_start && content.has_parameters && !is_first) ++with_parameters;
        is_first = false;
        if ((packet.flags & AV_PKT_FLAG_DISCARD) != 0) {
            ++discarded_in_all_;
            continue;
        }
        times_.push_back(packet.pts);
        const std::int64_t decoded = packet.dts == AV_NOPTS_VALUE ? packet.pts : packet.dts;
        if (content.is_start) starts_.push_back({packet.pts, decoded});
    }
    noted_ = static_cast<std::int64_t>(times_.size());
    // Parameters of one start may hold until the next that has some.
    tells = tells && begins_with_start_ &&
            (with_parameters == 0 || with_parameters + 1 >= starts_.size());
    const std::int64_t first = times_.empty() ? 0 : times_.front();
    std::sort(times_.begin(), times_.end());
    std::sort(starts_.begin(), starts_.end(),
              [](const Start& a, const Start& b) { return a.shown < b.shown; });
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
    has_begun_ = false;
    start_ = AV_NOPTS_VALUE;
    shown_ = 0;
    discarded_ = 0;
    ahead_.clear();
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
