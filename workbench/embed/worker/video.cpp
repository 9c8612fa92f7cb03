// Decodes video with FFmpeg's libraries. Frames have the bytes of
// `ffmpeg -i FILE -fps_mode passthrough -f rawvideo -pix_fmt rgb24 -`.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "embed/worker/pictures.hpp"
#include "embed/worker/worker.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::embed::worker {

namespace {

using namespace recordings::frames;

// https://www.rfc-editor.org/rfc/rfc8794 (EBML), section 11, and RFC 9559 (Matroska)
constexpr std::uint64_t kHead = 0x1A45DFA3;
constexpr std::uint64_t kSegment = 0x18538067;

/// Reads elements of EBML: an identifier, a size, and the content.
class Elements {
public:
    explicit Elements(std::istream& from) : from_(from) {}

    std::optional<std::uint64_t> identifier() { return number(true); }
    /// Reads a size; nothing where it is unknown, as in a live stream.
    std::optional<std::uint64_t> size() { return number(false); }

private:
    /// Reads a number, whose first byte has as many leading zeros as bytes follow.
    std::optional<std::uint64_t> number(bool with_mark) {
        const int first = from_.get();
        if (first <= 0) return std::nullopt;
        const auto more = static_cast<unsigned>(std::countl_zero(static_cast<std::uint8_t>(first)));
        std::uint64_t value = static_cast<unsigned>(first) & (with_mark ? 0xFFU : 0x7FU >> more);
        for (unsigned i = 0; i < more; ++i) {
            const int byte = from_.get();
            if (byte < 0) return std::nullopt;
            value = value << 8U | static_cast<unsigned>(byte);
        }
        const std::uint64_t unknown = (std::uint64_t{1} << 7U * (more + 1)) - 1;
        if (!with_mark && value == unknown) return std::nullopt;
        return value;
    }

    std::istream& from_;
};

std::string why_cut_matroska(std::ifstream& file, std::uint64_t length) {
    Elements elements(file);
    if (elements.identifier() != kHead) return "";
    const auto head = elements.size();
    if (!head || *head > length) return "";
    file.seekg(static_cast<std::streamoff>(*head), std::ios::cur);
    if (elements.identifier() != kSegment) return "";
    const auto segment = elements.size();
    if (!segment) return "";
    const std::uint64_t end = static_cast<std::uint64_t>(file.tellg()) + *segment;
    if (end <= length) return "";
    return "is cut: it has " + std::to_string(length) + " bytes, expected " + std::to_string(end);
}

/// Says why a file is cut, where its head (Matroska, WebM) or its end (GIF) shows it; else "". The
/// frames of other containers are counted.
std::string why_cut(const std::string& path) {
    std::error_code error;
    const std::uint64_t length = std::filesystem::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    if (error || !file) return "";
    std::array<char, 4> begin{};
    file.read(begin.data(), begin.size());
    if (std::string_view(begin.data(), begin.size()) == "GIF8") {
        file.seekg(-1, std::ios::end);
        return file.get() == ';' ? "" : "is cut: its end is missing";
    }
    file.clear();
    file.seekg(0);
    return why_cut_matroska(file, length);
}

struct Choice {
    std::vector<std::int64_t> only;
    std::int64_t first = 0;
    std::int64_t count = INT64_MAX;
    std::int64_t skip = 0;  ///< steps to leave out after `first`
    double rate = 0;
    std::optional<std::int64_t> total;  ///< number of frames that the video must have

    /// Returns whether no frame from this one on is wanted.
    bool ends_before(std::int64_t frame) const {
        if (!only.empty()) return frame > only.back();
        return frame >= first && frame - first >= count;
    }
    bool takes(std::int64_t frame, std::int64_t stride) const {
        if (!only.empty()) return std::binary_search(only.begin(), only.end(), frame);
        return frame >= first && !ends_before(frame) && (frame - first) % stride == 0;
    }
    /// Returns the next wanted frame, from this one on.
    std::int64_t next_from(std::int64_t frame) const {
        if (only.empty()) return std::max(first, frame);
        return *std::lower_bound(only.begin(), only.end(), frame);
    }
    bool is_all() const { return only.empty() && count == INT64_MAX; }
};

Choice choice_of(const Words& options) {
    const auto whole = [](double value) { return static_cast<std::int64_t>(value); };
    Choice choice;
    for (const double frame : options.numbers("--only")) choice.only.push_back(whole(frame));
    for (const double frame : options.numbers("--first")) choice.first = whole(frame);
    for (const double frames : options.numbers("--count")) choice.count = whole(frames);
    for (const double steps : options.numbers("--skip")) choice.skip = whole(steps);
    for (const double rate : options.numbers("--rate")) choice.rate = rate;
    for (const double frames : options.numbers("--total")) choice.total = whole(frames);
    return choice;
}

/// Checks that frames come at the rate of the steps.
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
            refuse(kOutOfStep, "has " + number_text(frames_a_second_) +
                                   " frames a second, expected a multiple of the " +
                                   number_text(rate) + " steps of the spec");
    }

    std::int64_t stride() const { return stride_; }

    /// Sets the time stamp of frame 0.
    void begin(std::int64_t stamp) { begin_ = double(stamp) * seconds_; }

    /// Refuses a frame that is more than half a frame from its place. Where frames were lost, all
    /// behind them belong to other steps: refuses them too where steps are more than one and a half
    /// apart.
    void check(const AVFrame& picture, std::int64_t frame) {
        if (rate_ == 0 || picture.best_effort_timestamp == AV_NOPTS_VALUE) return;
        const double time = double(picture.best_effort_timestamp) * seconds_;
        if (frame == 0) begin(picture.best_effort_timestamp);
        const double place = double(frame) / frames_a_second_;
        const double between = (time - before_time_) * frames_a_second_;
        if (frame > 0 && frame == before_ + 1 && between > 1 + double(stride_) / 2)
            refuse(kOutOfStep,
                   "has frame " + std::to_string(frame) + " " + number_text(time - before_time_) +
                       " s after the one before, expected " + number_text(1 / frames_a_second_) +
                       " s: frames are missing between them. Cut the video there, or "
                       "repeat a frame for each (ffmpeg -fps_mode cfr)");
        before_ = frame;
        before_time_ = time;
        if (std::abs(time - begin_ - place) * frames_a_second_ > 0.5)
            refuse(kOutOfStep, "has frame " + std::to_string(frame) + " at " +
                                   number_text(time - begin_) + " s, expected it at " +
                                   number_text(place) + " s: its frames are not evenly spaced");
    }

private:
    double seconds_;  ///< seconds per unit of time stamps
    double rate_;
    double frames_a_second_ = 0;
    double begin_ = 0;
    std::int64_t before_ = -1;  ///< the last frame that was checked, and its time
    double before_time_ = 0;
    std::int64_t stride_ = 1;
};

void check_count(const Decoder& decoder, const Choice& choice) {
    const std::int64_t shown = decoder.shown();
    if (shown == 0) refuse(kRefused, "holds no frame, expected at least one");
    const bool is_cut = decoder.promised() > 0 && decoder.promised() != shown;
    if (choice.total && *choice.total != shown && !is_cut)
        refuse(kOtherCount, "has " + std::to_string(shown) + " frames, expected the " +
                                std::to_string(*choice.total));
    const std::int64_t last = choice.only.empty() ? choice.first : choice.only.back();
    const bool too_few = choice.only.empty() && !choice.is_all() && shown - last < choice.count;
    if (shown <= last || too_few)
        refuse(kNoSuchFrame, "has " + std::to_string(shown) + " frames; there is no frame " +
                                 std::to_string(too_few ? last + choice.count - 1 : last) +
                                 " (from 0)");
    if (is_cut)
        refuse(kRefused, "promises " + std::to_string(decoder.promised()) + " frames and holds " +
                             std::to_string(shown) + ": it is cut or damaged");
}

}  // namespace

void send_video(const std::string& path, const Words& options) {
    av_log_set_level(AV_LOG_QUIET);
    if (const std::string why = why_cut(path); !why.empty()) refuse(kRefused, why);
    Choice choice = choice_of(options);
    Decoder decoder("file:" + path);
    Clock clock(decoder.stream(), choice.rate);
    choice.first += choice.skip * clock.stride();
    Converter converter;
    const int turns = quarter_turns(decoder.stream());
    Pace pace(decoder.stream(), options.text("--pace", "") == "real");
    const Picture picture(av_frame_alloc());
    const bool is_as_long = !choice.total || decoder.counted() == choice.total;
    for (;;) {
        if (is_as_long && choice.ends_before(decoder.shown())) return;
        decoder.go_towards(choice.next_from(decoder.shown()));
        if (decoder.first_time() != AV_NOPTS_VALUE) clock.begin(decoder.first_time());
        const std::int64_t frame = decoder.shown();
        if (!decoder.next(picture.get())) {
            check_count(decoder, choice);
            return;
        }
        clock.check(*picture, frame);
        if (!choice.takes(frame, clock.stride())) continue;
        pace.stamp(*picture, frame);
        send(*picture, converter, turns, frame);
    }
}

// etlc-embed-video: the only part that loads FFmpeg, whose libraries are many.

namespace {

/// The words are those of etlc-embed behind "video".
void run(const std::vector<std::string>& words) {
    if (words.empty())
        refuse(recordings::frames::kWrongCall, "etlc-embed-video belongs to etlc-embed: FILE ...");
    limit_resources(recordings::frames::kMaxMemoryBytes);
    const Words options({words.begin() + 1, words.end()});
    if (options.text("--pace", "") == "live")
        send_live(words[0]);
    else
        send_video(words[0], options);
}

}  // namespace

}  // namespace etlc::embed::worker

int main(int argc, char** argv) {
    return etlc::embed::worker::guarded(argc, argv, etlc::embed::worker::run);
}
