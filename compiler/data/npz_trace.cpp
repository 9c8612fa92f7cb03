#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "data/elements.hpp"
#include "data/npy.hpp"
#include "data/npy_header.hpp"
#include "data/quote.hpp"
#include "data/rows.hpp"
#include "data/trace_formats.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;
using Kind = Channel::Kind;

/// One channel and the array that feeds it.
struct Feed {
    Channel channel;
    NpyHeader header;
    std::unique_ptr<Rows> rows;  ///< null: an optional channel that the archive lacks
};

Failure of_channel(const Failure& failure, const Channel& channel) {
    return of_trace(in_array(failure, channel.name));
}

std::optional<Failure> check_elements(const NpyHeader& header, const Channel& channel) {
    if (header.element != Element::boolean || channel.kind == Kind::boolean) return {};
    return Failure{Code::trace_elements, "has bool elements, expected numbers: the input is no bool"};
}

/// T or T x 1 for scalars and bools, T x D for vectors, and T where D is 1.
std::optional<Failure> check_shape(const NpyHeader& header, const Channel& channel) {
    const auto& shape = header.shape;
    const bool flat = shape.size() == 1 && channel.width == 1;
    const bool table = shape.size() == 2 && shape[1] == channel.width;
    if (flat || table) return {};
    const std::string expected =
        channel.kind == Kind::vector ? fmt::format("(steps, {})", channel.width) : "(steps,) or (steps, 1)";
    return Failure{Code::trace_shape, fmt::format("has shape {}, expected {}", shape_text(shape), expected)};
}

diag::Result<Feed> open_feed(const ArchivePlace& place, const Channel& channel) {
    const auto archive = Archive::open(place);
    if (!archive) return of_trace(archive.failure());
    const auto& keys = archive->keys();
    if (channel.optional && std::find(keys.begin(), keys.end(), channel.name) == keys.end())
        return Feed{channel, {}, nullptr};
    auto member = archive->member(channel.name);
    if (!member) return of_trace(member.failure());
    auto header = read_npy_header(**member);
    if (!header) return of_channel(header.failure(), channel);
    if (auto failure = check_elements(*header, channel)) return of_channel(*failure, channel);
    if (auto failure = check_shape(*header, channel)) return of_channel(*failure, channel);
    auto rows = open_rows(std::move(*member), *header, header->shape[0], channel.width);
    if (!rows) return of_channel(rows.failure(), channel);
    return Feed{channel, std::move(*header), std::move(*rows)};
}

class NpzTrace final : public Trace {
public:
    NpzTrace(std::vector<Feed> feeds, std::uint64_t length) : feeds_(std::move(feeds)), length_(length) {}

    std::uint64_t length() const override { return length_; }
    bool has(std::size_t channel) const override { return feeds_[channel].rows != nullptr; }

    diag::Result<bool> next(Sample& sample) override {
        if (step_ == length_) return false;
        sample.values.resize(feeds_.size());
        sample.present.assign(feeds_.size(), true);
        for (std::size_t c = 0; c < feeds_.size(); ++c) {
            if (!has(c)) {
                sample.present[c] = false;
                sample.values[c].assign(feeds_[c].channel.width, std::numeric_limits<double>::quiet_NaN());
                continue;
            }
            const auto row = feeds_[c].rows->next();
            if (!row) return of_channel(row.failure(), feeds_[c].channel);
            if (auto failure = copy(*row, feeds_[c].channel, sample.values[c])) return *failure;
        }
        ++step_;
        return true;
    }

private:
    std::optional<Failure> copy(const double* row, const Channel& channel, std::vector<double>& values) const {
        values.assign(row, row + channel.width);
        for (double& value : values) {
            if (!std::isfinite(value)) {
                value = std::numeric_limits<double>::quiet_NaN();
            } else if (channel.kind == Kind::boolean && value != 0 && value != 1) {
                return Failure{Code::trace_elements, fmt::format("array {}: holds {} in step {}, expected 0 or 1",
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

diag::Failure of_trace(Failure failure) {
    switch (failure.code) {
        case Code::unreadable_data_file: failure.code = Code::unreadable_trace; break;
        case Code::unknown_data_format: failure.code = Code::unknown_trace_format; break;
        case Code::unsupported_elements: failure.code = Code::trace_elements; break;
        case Code::no_such_array: failure.code = Code::no_such_channel; break;
        case Code::malformed_array:
        case Code::wrong_array_size:
        case Code::array_too_large:
        case Code::malformed_archive: failure.code = Code::malformed_trace_array; break;
        default: break;
    }
    return failure;
}

diag::Result<std::unique_ptr<Trace>> open_npz_trace(const ArchivePlace& place, const std::vector<Channel>& channels) {
    std::vector<Feed> feeds;
    const Feed* first = nullptr;  // of those that are there
    feeds.reserve(channels.size());
    for (const Channel& channel : channels) {
        auto feed = open_feed(place, channel);
        if (!feed) return feed.failure();
        feeds.push_back(std::move(*feed));
        const Feed& last = feeds.back();
        if (last.rows == nullptr) continue;
        if (first == nullptr) first = &last;
        if (last.header.shape[0] != first->header.shape[0])
            return Failure{Code::trace_shape, fmt::format("arrays differ in length: {} has {} steps, {} has {}",
                                                          in_quotes(first->channel.name), first->header.shape[0],
                                                          in_quotes(channel.name), last.header.shape[0])};
    }
    if (first == nullptr)
        return Failure{Code::trace_shape,
                       "the spec reads no input, so the arrays do not tell how many steps there are"};
    const std::uint64_t length = first->header.shape[0];
    return std::unique_ptr<Trace>(std::make_unique<NpzTrace>(std::move(feeds), length));
}

}  // namespace etlc::data
