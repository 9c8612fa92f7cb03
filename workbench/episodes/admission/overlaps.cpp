#include "episodes/admission/overlaps.hpp"

#include <algorithm>

#include "data/traces/overlap.hpp"

namespace etlc::episodes {

OverlapSearch::OverlapSearch(const Identities& episodes, std::vector<Source> sources,
                             bool each_other) {
    bool compares = each_other;
    for (Source& source : sources) {
        std::sort(source.hashes.begin(), source.hashes.end());
        compares = compares || !source.contents.empty();
    }
    using Content = data::EpisodeContent;
    if (compares) {
        data::Suspects suspects(each_other);
        episodes.for_each([&](std::size_t, const Recorded& one) { suspects.ask(one.content); });
        for (const Source& source : sources)
            source.contents.for_each_of(
                source.hashes, [&](std::uint64_t, const Content& of) { suspects.know(of); });
        is_suspect_ = suspects.find();
    } else {
        is_suspect_.resize(episodes.size());
    }
    std::size_t next = episodes.size();
    for (Source& source : sources) {
        Seen& seen = seen_.emplace_back();
        source.contents.for_each_of(source.hashes, [&](std::uint64_t, const Content& content) {
            if (is_suspect_[next++]) seen.suspects.add(content);
        });
        seen.hashes = std::move(source.hashes);
    }
}

std::optional<data::Overlap> OverlapSearch::find(std::size_t source, std::size_t e,
                                                 const Recorded& episode) const {
    const Seen& seen = seen_[source];
    if (std::binary_search(seen.hashes.begin(), seen.hashes.end(), hash_of(episode)))
        return data::Overlap{0, 1, true};
    return is_suspect_[e] ? seen.suspects.find(episode.content) : std::nullopt;
}

std::optional<data::Overlap> OverlapSearch::find_earlier(std::size_t e, const Recorded& episode) {
    if (!is_suspect_[e]) return std::nullopt;
    auto found = earlier_.find(episode.content);
    if (found) found->other = numbers_[found->other];
    earlier_.add(episode.content);
    numbers_.push_back(e);
    return found;
}

Overlaps overlaps(const Identities& episodes) {
    OverlapSearch search(episodes, {}, true);
    Overlaps result;
    episodes.for_each([&](std::size_t e, const Recorded& episode) {
        const auto overlap = search.find_earlier(e, episode);
        result.repeated += overlap && overlap->equal ? 1 : 0;
        result.overlapping += overlap && !overlap->equal ? 1 : 0;
    });
    return result;
}

}  // namespace etlc::episodes
