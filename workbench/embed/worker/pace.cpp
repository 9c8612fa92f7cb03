#include "embed/worker/pace.hpp"

#include <thread>

#include "embed/worker/worker.hpp"

namespace etlc::embed::worker {

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
