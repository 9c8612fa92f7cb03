#include "fit/even_frames.hpp"

#include <utility>

namespace etlc::fit {

void EvenFrames::add(std::uint64_t step, const std::vector<float>& values) {
    const bool far_enough = since_change_ == away_;
    if (!far_enough) ++since_change_;
    pending_.push_back({step, far_enough ? values : std::vector<float>{}});
    if (pending_.size() <= away_) return;
    keep(std::move(pending_.front()));
    pending_.pop_front();
}

void EvenFrames::add_other() {
    pending_.clear();
    since_change_ = 0;
}

void EvenFrames::keep(TakenFrame frame) {
    if (frame.values.empty()) return;
    if (sound_++ % stride_ != 0) return;
    kept_.push_back(std::move(frame));
    if (kept_.size() < 2 * most_) return;
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i)
        if (i > 0) kept_[i] = std::move(kept_[2 * i]);
    kept_.resize(most_);
    stride_ *= 2;
}

std::vector<TakenFrame> EvenFrames::take() {
    for (TakenFrame& frame : pending_) keep(std::move(frame));
    pending_.clear();
    if (kept_.size() <= most_) return std::move(kept_);
    std::vector<TakenFrame> result;
    for (std::size_t i = 0; i < most_; ++i)
        result.push_back(std::move(kept_[i * kept_.size() / most_]));
    return result;
}

}  // namespace etlc::fit
