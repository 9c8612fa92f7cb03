#include "plan/evaluate/past_state.hpp"

#include <algorithm>

namespace etlc::plan {

namespace {

using Least = etlmon::Least<etlmon::Key>;
using Greatest = etlmon::Greatest<etlmon::Key>;

}  // namespace

PastState::PastState(const check::Past& past) : kind_(past.kind), steps_(past.steps) {
    if (kind_ == Kind::min || kind_ == Kind::max)
        keys_.resize(etlmon::window_elements(steps_));
    else
        bits_.resize(steps_);
    reset();
}

void PastState::reset() {
    cursor_ = 0;
    count_ = 0;
    mean_.reset();
    std::fill(bits_.begin(), bits_.end(), etlmon::detail::kMissingBits);
    if (kind_ == Kind::min) etlmon::window_reset<Least>(keys_.data(), cursor_, steps_);
    if (kind_ == Kind::max) etlmon::window_reset<Greatest>(keys_.data(), cursor_, steps_);
}

float PastState::push(float x) {
    const std::uint32_t bits = etlmon::bits_of(x);
    switch (kind_) {
        case Kind::ago:
            return etlmon::float_of_bits(etlmon::delay_push(bits_.data(), cursor_, steps_, bits));
        case Kind::mean:
            return etlmon::float_of_bits(etlmon::mean_push(bits_.data(), mean_, steps_, bits));
        case Kind::min:
            return etlmon::float_of_bits(
                etlmon::extreme_push<Least>(keys_.data(), cursor_, count_, steps_, bits));
        case Kind::max:
            return etlmon::float_of_bits(
                etlmon::extreme_push<Greatest>(keys_.data(), cursor_, count_, steps_, bits));
        case Kind::count: break;
    }
    return etlmon::kMissing;
}

bool PastState::fits() const {
    const std::uint32_t places = keys_.empty() ? steps_ : std::max(steps_ & ~1U, 1U);
    return cursor_ < std::max(places, 1U) && count_ <= steps_ &&
           mean_.cursor < std::max(steps_, 1U) && mean_.count <= steps_;
}

}  // namespace etlc::plan
