#include <algorithm>

#include "data/arrays/npy.hpp"
#include "data/arrays/npy_header.hpp"
#include "data/traces/array_trace.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

Failure of_channel(const Failure& failure, const Channel& channel) {
    return of_trace(in_array(failure, channel.name));
}

diag::Result<Feed> open_feed(const ArchivePlace& place, const Channel& channel) {
    const auto archive = Archive::open(place);
    if (!archive) return of_trace(archive.failure());
    const auto& keys = archive->keys();
    if (channel.optional && std::find(keys.begin(), keys.end(), channel.name) == keys.end())
        return Feed{channel, 0, nullptr};
    auto member = archive->member(channel.name);
    if (!member) return of_trace(member.failure());
    auto header = read_npy_header(**member);
    if (!header) return of_channel(header.failure(), channel);
    const bool has_bools = header->element == Element::boolean;
    if (auto failure = check_array(header->shape, has_bools, channel)) return *failure;
    auto rows = open_rows(std::move(*member), *header, header->shape[0], channel.width);
    if (!rows) return of_channel(rows.failure(), channel);
    return Feed{channel, header->shape[0], std::move(*rows)};
}

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

diag::Result<std::unique_ptr<Trace>> open_npz_trace(const ArchivePlace& place,
                                                    const std::vector<Channel>& channels) {
    std::vector<Feed> feeds;
    for (const Channel& channel : channels) {
        auto feed = open_feed(place, channel);
        if (!feed) return feed.failure();
        feeds.push_back(std::move(*feed));
    }
    return open_array_trace(std::move(feeds));
}

}  // namespace etlc::data
