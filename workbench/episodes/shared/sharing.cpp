#include "episodes/shared/sharing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"
#include "recordings/open.hpp"

namespace etlc::episodes {

namespace {

using diag::Code;
using diag::Failure;

constexpr std::string_view kMagic = "etlc part 1\n";
constexpr std::size_t kHash = 8;  ///< bytes at the end of the file: hash of all before
constexpr std::uint64_t kLargest = std::uint64_t{1} << 40U;

/// Returns whether two parts belong to one call.
bool same_call(const Part& a, const Part& b) {
    return a.etlc == b.etlc && a.call == b.call && a.loaded == b.loaded && a.shards == b.shards &&
           a.episodes == b.episodes && a.labelled == b.labelled;
}

std::string difference(const Part& a, const Part& b) {
    if (a.etlc != b.etlc) return fmt::format("is of etlc {}, the first of {}", b.etlc, a.etlc);
    if (a.call != b.call)
        return fmt::format("is of the call 'etlc {}', the first of 'etlc {}'",
                           fmt::join(b.call, " "), fmt::join(a.call, " "));
    if (a.shards != b.shards)
        return fmt::format("is one of {} shards, the first one of {}", b.shards, a.shards);
    if (a.loaded != b.loaded)
        return "was made with another spec, or other targets, thresholds or tables of labels, "
               "than the first";
    if (a.episodes != b.episodes) return "was made over other episodes than the first";
    return "was made with other labels in the first episode";
}

struct Cached {
    std::vector<std::string> episodes;
    std::vector<std::uint64_t> contents;
};

template <class Archive>
void fields(Archive& archive, Cached& cache) {
    archive(cache.episodes, cache.contents);
}

std::optional<Cached> read(const std::string& path) {
    const auto bytes = data::read_file(path, kLargest, Code::unreadable_part);
    return bytes ? data::unpacked<Cached>(*bytes) : std::nullopt;
}

}  // namespace

std::string write(const Part& part) {
    return as_file(data::packed(part));
}

std::string as_file(std::string_view body) {
    std::string bytes{kMagic};
    bytes += body;
    data::Writer hash;
    hash(data::xxh64(bytes));
    return bytes + hash.bytes();
}

diag::Result<Part> parse_part(std::string_view bytes) {
    const Failure damaged{Code::damaged_part, "is truncated, or was changed after it was written"};
    if (!bytes.starts_with(kMagic))
        return Failure{Code::damaged_part,
                       fmt::format("is no part of a result: expected {} at its begin",
                                   data::in_quotes(std::string(kMagic.substr(0, 11))))};
    if (bytes.size() < kMagic.size() + kHash) return damaged;
    data::Writer hash;
    hash(data::xxh64(bytes.substr(0, bytes.size() - kHash)));
    if (bytes.substr(bytes.size() - kHash) != hash.bytes()) return damaged;
    auto part =
        data::unpacked<Part>(bytes.substr(kMagic.size(), bytes.size() - kMagic.size() - kHash));
    if (!part || part->shard == 0 || part->shard > part->shards || part->shards > kMostShards ||
        part->call.empty())
        return damaged;
    if (!part->results.empty() && part->results.rbegin()->first >= part->episodes.size())
        return damaged;
    return std::move(*part);
}

diag::Result<Part> read_part(const std::string& path) {
    const auto bytes = data::read_file(path, kLargest, Code::unreadable_part);
    if (!bytes) return bytes.failure();
    return parse_part(*bytes);
}

bool Joined::add(Part part, const std::string& path, diag::Sink& sink) {
    const auto refuse = [&](Code code, std::string why) -> diag::Diagnostic& {
        return sink.report(data::in_file({code, std::move(why)}, path));
    };
    const auto results = std::exchange(part.results, {});
    if (shards_.empty()) {
        call_ = std::move(part);
        at_.assign(call_.episodes.size(), kNone);
        first_ = path;
        shards_.emplace(call_.shard, path);
    } else if (!same_call(call_, part)) {
        refuse(Code::part_of_another, difference(call_, part))
            .note(fmt::format("the first is {}", first_));
        return false;
    } else if (const auto [before, is_new] = shards_.emplace(part.shard, path); !is_new) {
        refuse(Code::incomplete_parts, fmt::format("is shard {} of {}, which {} is as well",
                                                   part.shard, part.shards, before->second));
        return false;
    }
    for (const auto& [place, bytes] : results) {
        if (at_[place] != kNone) {
            refuse(Code::incomplete_parts,
                   fmt::format("has {}, which another shard has as well: its file has changed "
                               "in between",
                               call_.episodes[place]));
            return false;
        }
        at_[place] = static_cast<std::uint32_t>(results_.size());
        results_.add(bytes);
    }
    return true;
}

bool Joined::is_complete(diag::Sink& sink) const {
    std::vector<std::uint32_t> missing;
    for (std::uint32_t shard = 1; shard <= call_.shards; ++shard)
        if (!shards_.contains(shard)) missing.push_back(shard);
    if (!missing.empty()) {
        constexpr std::size_t kMostTold = 8;
        const auto end =
            missing.begin() + static_cast<std::ptrdiff_t>(std::min(missing.size(), kMostTold));
        sink.report(data::in_file(
            {Code::incomplete_parts,
             fmt::format("is one of {}; missing: {}{}", diag::counted(call_.shards, "shard"),
                         fmt::join(missing.begin(), end, ", "),
                         missing.size() > kMostTold ? ", ..." : "")},
            first_));
        return false;
    }
    const auto unread = std::find(at_.begin(), at_.end(), kNone);
    if (unread == at_.end()) return true;
    sink.report(data::in_file(
        {Code::incomplete_parts, "no shard has read it: its file has changed in between"},
        call_.episodes[static_cast<std::size_t>(unread - at_.begin())]));
    return false;
}

std::uint64_t content_of(const std::string& episode) {
    const std::string file = data::trace_file(episode);
    return data::xxh64(data::ends_of_file(file) + episode.substr(file.size()));
}

std::vector<std::uint64_t> contents_of(const std::vector<std::string>& episodes,
                                       const std::string& cache) {
    if (!cache.empty())
        if (auto found = read(cache);
            found && found->episodes == episodes && found->contents.size() == episodes.size())
            return std::move(found->contents);
    std::vector<std::uint64_t> contents;
    contents.reserve(episodes.size());
    for (const std::string& episode : episodes) contents.push_back(content_of(episode));
    // If writing fails, the next process reads the episodes again.
    if (!cache.empty())
        static_cast<void>(data::write_file_atomically(
            cache, data::packed(Cached{episodes, contents}), Code::unwritable_output));
    return contents;
}

}  // namespace etlc::episodes
