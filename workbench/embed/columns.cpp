#include "embed/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "data/traces/csv.hpp"
#include "recordings/open.hpp"

namespace etlc::embed {

namespace {

using data::Channel;
using diag::Code;
using diag::Failure;

/// Returns how a column is read, by its name.
diag::Result<Channel> channel_of(const check::Model& model, const data::ElementName& column) {
    Channel channel{column.array, column.element ? Channel::Kind::vector : Channel::Kind::scalar, 1,
                    false};
    if (column.array.starts_with("truth.")) channel.kind = Channel::Kind::boolean;
    for (const check::Input& input : model.inputs) {
        if (input.name != column.array) continue;
        if (input.encoder != check::kNone)
            return Failure{
                Code::no_such_channel,
                fmt::format("has a column {}, which '{}' makes of the frames",
                            data::in_quotes(column.array), model.encoders[input.encoder].name),
                1, 1};
        if (input.type == check::InputType::boolean) channel.kind = Channel::Kind::boolean;
    }
    return channel;
}

diag::Result<std::vector<Channel>> channels_of(const check::Model& model, const std::string& path) {
    auto source = data::open_file(path);
    if (!source) return source.failure();
    data::CsvReader header(std::move(*source));
    const auto read = header.next();
    if (!read) return read.failure();
    std::vector<Channel> channels;
    for (std::size_t i = 0; *read && i < header.cells(); ++i) {
        const data::ElementName column = data::element_name(header.cell(i));
        const auto same = [&](const Channel& other) { return other.name == column.array; };
        const auto known = std::find_if(channels.begin(), channels.end(), same);
        if (known != channels.end()) {
            known->width = std::max(known->width, column.element.value_or(0) + 1);
            continue;
        }
        auto channel = channel_of(model, column);
        if (!channel) return channel.failure();
        channel->width = column.element.value_or(0) + 1;
        channels.push_back(std::move(*channel));
    }
    constexpr std::uint32_t kMostElements = 1U << 20U;  // no row of a file has more cells
    for (const Channel& channel : channels)
        if (channel.width > kMostElements)
            return Failure{Code::trace_shape,
                           fmt::format("has a column {}[{}], expected at most {} elements",
                                       channel.name, channel.width - 1, kMostElements),
                           1, 1};
    return channels;
}

/// Reads every `stride`-th step of a trace.
diag::Result<std::vector<Array>> read_arrays(data::Trace& trace,
                                             const std::vector<Channel>& channels,
                                             std::uint64_t stride) {
    std::vector<Array> arrays;
    for (const Channel& channel : channels)
        arrays.push_back({channel.name, channel.width, {}, channel.kind == Channel::Kind::vector});
    data::Sample sample;
    for (std::uint64_t step = 0;; ++step) {
        const auto more = trace.next(sample);
        if (!more) return more.failure();
        if (!*more) return arrays;
        if (step % stride != 0) continue;
        for (std::size_t c = 0; c < arrays.size(); ++c)
            for (const double value : sample.values[c])
                arrays[c].values.push_back(sample.present[c]
                                               ? static_cast<float>(value)
                                               : std::numeric_limits<float>::quiet_NaN());
    }
}

}  // namespace

diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path) {
    const auto channels = channels_of(model, path);
    if (!channels) return channels.failure();
    const auto trace = recordings::open_trace(path, *channels);
    if (!trace) return trace.failure();
    return read_arrays(**trace, *channels, 1);
}

diag::Result<std::vector<Array>> arrays_in(const check::Model& model, const Recording& recording,
                                           const recordings::NamesInFile& names) {
    std::vector<Channel> channels;
    for (const check::Input& input : model.inputs) {
        if (input.encoder != check::kNone) continue;
        Channel channel{input.name, Channel::Kind::scalar, 1, false};
        if (input.type == check::InputType::boolean) channel.kind = Channel::Kind::boolean;
        if (input.is_embedding()) {
            channel.kind = Channel::Kind::vector;
            channel.width = input.dimension;
        }
        channels.push_back(std::move(channel));
    }
    for (const auto& [name, in_file] : names)
        if (name.starts_with("truth."))
            channels.push_back({name, Channel::Kind::boolean, 1, false});
    if (channels.empty()) return std::vector<Array>{};
    const auto trace =
        recordings::open_trace(recording.columns, recordings::renamed(channels, names));
    if (!trace) return trace.failure();
    return read_arrays(**trace, channels, recording.stride);
}

}  // namespace etlc::embed
