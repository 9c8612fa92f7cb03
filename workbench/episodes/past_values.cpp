#include "episodes/past_values.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace etlc::episodes {

namespace {

using Kind = check::Past::Kind;

constexpr double kUnknownPast = std::numeric_limits<double>::quiet_NaN();

/// Adds to a sum without rounding: it is kept in parts whose bits do not overlap (Shewchuk 1997).
void add_exactly(std::vector<double>& parts, double x) {
    std::size_t kept = 0;
    for (const double part : parts) {
        const double sum = x + part;
        const double of_part = sum - x;
        const double rest = (x - (sum - of_part)) + (part - of_part);
        if (rest != 0) parts[kept++] = rest;
        x = sum;
    }
    parts.resize(kept);
    if (x != 0) parts.push_back(x);
}

}  // namespace

void PastValues::reset() {
    values_.clear();
    candidates_.clear();
    sum_.clear();
    frame_ = 0;
    above_ = 0;
    below_ = 0;
}

double PastValues::push(double value) {
    if (past_->kind == Kind::ago) {
        values_.push_back(value);
        if (values_.size() <= past_->steps) return kUnknownPast;
        const double ago = values_.front();
        values_.pop_front();
        return ago;
    }
    if (std::isnan(value)) {
        reset();
        return kUnknownPast;
    }
    if (past_->kind != Kind::mean) return extreme(value);
    values_.push_back(value);
    add(value, 1);
    if (values_.size() > past_->steps) {
        add(values_.front(), -1);
        values_.pop_front();
    }
    return values_.size() == past_->steps ? mean() : kUnknownPast;
}

void PastValues::add(double value, double sign) {
    if (!std::isinf(value)) return add_exactly(sum_, sign * value);
    std::size_t& count = value > 0 ? above_ : below_;
    count = sign > 0 ? count + 1 : count - 1;
}

double PastValues::mean() const {
    const double infinity = std::numeric_limits<double>::infinity();
    if (above_ > 0 && below_ > 0) return kUnknownPast;
    if (above_ > 0 || below_ > 0) return above_ > 0 ? infinity : -infinity;
    return std::accumulate(sum_.begin(), sum_.end(), 0.0) / past_->steps;
}

double PastValues::extreme(double value) {
    const auto outdone = [&](double other) {
        return past_->kind == Kind::min ? value <= other : value >= other;
    };
    while (!candidates_.empty() && outdone(candidates_.back().second)) candidates_.pop_back();
    candidates_.emplace_back(frame_, value);
    if (candidates_.front().first + past_->steps <= frame_) candidates_.pop_front();
    ++frame_;
    return frame_ >= past_->steps ? candidates_.front().second : kUnknownPast;
}

}  // namespace etlc::episodes
