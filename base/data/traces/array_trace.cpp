#include "data/traces/array_trace.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "data/arrays/npy.hpp"
#include "data/arrays/npy_header.hpp"
#include "data/text/quote.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;
using Kind = Channel::Kind;

/// Without branches or comparisons, several at a time: a billion elements pass here. An exponent of
/// ones alone, to which one is added, carries into the sign.
bool all_finite(const std::vector<double>& values) {
    constexpr std::uint64_t kExponent = 0x7ff0000000000000;
    constexpr std::uint64_t kOne = 0x0010000000000000;
    std::uint64_t found = 0;
    for (const double value : values)
        found |= (std::bit_cast<std::uint64_t>(value) & kExponent) + kOne;
    return found >> 63 == 0;
}

class ArrayTrace final : public Trace {
public:
    ArrayTrace(std::vector<Feed> feeds, std::uint64_t length)
        : feeds_(std::move(feeds)), length_(length) {}

    std::uint64_t length() const override { return length_; }
    bool has(std::size_t channel) const override { return feeds_[channel].rows != nullptr; }

    diag::Result<bool> next(Sample& sample) override {
        if (step_ == length_) return false;
        sample.values.resize(feeds_.size());
        sample.present.assign(feeds_.size(), true);
        for (std::size_t c = 0; c < feeds_.size(); ++c) {
            if (!has(c)) {
                sample.present[c] = false;
                sample.values[c].assign(feeds_[c].channel.width,
                                        std::numeric_limits<double>::quiet_NaN());
                continue;
            }
            const auto row = feeds_[c].rows->next();
            if (!row) return of_trace(in_array(row.failure(), feeds_[c].channel.name));
            if (auto failure = copy(*row, feeds_[c].channel, sample.values[c])) return *failure;
        }
        ++step_;
        return true;
    }

private:
    std::optional<Failure> copy(const double* row, const Channel& channel,
                                std::vector<double>& values) const {
        values.assign(row, row + channel.width);
        const bool sound = channel.kind != Kind::boolean && all_finite(values);
        for (double& value : sound ? std::span<double>() : std::span(values)) {
            if (!std::isfinite(value)) {
                value = std::numeric_limits<double>::quiet_NaN();
            } else if (channel.kind == Kind::boolean && value != 0 && value != 1) {
                return Failure{Code::trace_elements,
                               fmt::format("array {}: holds {} in step {}, expected 0 or 1",
                                           in_quotes(channel.name), value, step_)};
            }
        }
        return {};
    }

    std::vector<Feed> feeds_;
    std::uint64_t length_;
    std::uint64_t step_ = 0;
};

}  // namespace

std::optional<Failure> check_array(const std::vector<std::uint64_t>& shape, bool has_bools,
                                   const Channel& channel) {
    if (has_bools && channel.kind != Kind::boolean)
        return in_array(
            {Code::trace_elements, "has bool elements, expected numbers: the input is no bool"},
            channel.name);
    const bool flat = shape.size() == 1 && channel.width == 1;
    const bool table = shape.size() == 2 && shape[1] == channel.width;
    if (flat || table) return {};
    const std::string expected = channel.kind == Kind::vector
                                     ? fmt::format("(steps, {})", channel.width)
                                     : "(steps,) or (steps, 1)";
    return in_array(
        {Code::trace_shape, fmt::format("has shape {}, expected {}", shape_text(shape), expected)},
        channel.name);
}

diag::Result<std::unique_ptr<Trace>> open_array_trace(std::vector<Feed> feeds) {
    const Feed* first = nullptr;  // of those that are there
    for (const Feed& feed : feeds) {
        if (feed.rows == nullptr) continue;
        if (first == nullptr) first = &feed;
        if (feed.steps != first->steps)
            return Failure{Code::trace_shape,
                           fmt::format("arrays differ in length: {} has {} steps, {} has {}",
                                       in_quotes(first->channel.name), first->steps,
                                       in_quotes(feed.channel.name), feed.steps)};
    }
    if (first == nullptr)
        return Failure{
            Code::trace_shape,
            "the spec reads no input, so the arrays do not tell how many steps there are"};
    const std::uint64_t length = first->steps;
    return std::unique_ptr<Trace>(std::make_unique<ArrayTrace>(std::move(feeds), length));
}

}  // namespace etlc::data
