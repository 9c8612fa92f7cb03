#include "data/traces/known.hpp"

#include <algorithm>
#include <cstring>

#include "data/spill/pack.hpp"

namespace etlc::data {

void KnownEpisodes::add(std::uint64_t hash, const EpisodeContent& content) {
    if (all_ == nullptr) all_ = std::make_shared<All>();
    if (all_.use_count() > 1) {
        KnownEpisodes mine;
        for_each([&](std::uint64_t known, const EpisodeContent& of) { mine.add(known, of); });
        *this = std::move(mine);
        if (all_ == nullptr) all_ = std::make_shared<All>();
    }
    const std::string bytes = packed(content);
    const std::uint64_t at = all_->contents.append(packed(bytes.size()));
    all_->contents.append(bytes);
    all_->places.add({hash, at});
}

EpisodeContent KnownEpisodes::read(const SpillFile& contents, std::uint64_t at) {
    const auto bytes = [&](std::size_t n) {
        std::string result(n, '\0');
        contents.read(at, result.data(), n);
        at += n;
        return result;
    };
    const auto size = unpacked<std::size_t>(bytes(packed(std::size_t{}).size()));
    const bool fits = size && *size <= contents.size() - at;
    auto content = fits ? unpacked<EpisodeContent>(bytes(*size)) : std::nullopt;
    if (!content) throw SpillError("a temporary file was changed by another program");
    return std::move(*content);
}

void KnownEpisodes::for_each(const Visit& visit) const {
    if (all_ == nullptr) return;
    const std::shared_ptr<All> all = all_;  // which `visit` may change
    std::optional<Place> last;
    const auto pass_on = [&] {
        if (last) visit(last->hash, read(all->contents, last->at));
    };
    all->places.for_each([&](const Place& place) {
        if (last && last->hash != place.hash) pass_on();
        last = place;
    });
    pass_on();
}

void KnownEpisodes::for_each_of(const std::vector<std::uint64_t>& hashes,
                                const Visit& visit) const {
    if (hashes.empty()) return;
    for_each([&](std::uint64_t hash, const EpisodeContent& content) {
        if (std::binary_search(hashes.begin(), hashes.end(), hash)) visit(hash, content);
    });
}

void KnownEpisodes::keep(const std::vector<std::uint64_t>& hashes) {
    KnownEpisodes kept;
    for_each_of(hashes, [&](std::uint64_t hash, const EpisodeContent& of) { kept.add(hash, of); });
    *this = std::move(kept);
}

}  // namespace etlc::data
