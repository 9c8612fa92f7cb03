#include "data/traces/overlap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <unordered_map>

#include "data/files/hash.hpp"

namespace etlc::data {
namespace {

constexpr std::size_t kAtLeastKept = 64;
constexpr std::uint32_t kAlwaysKept = (1U << 28U) - 1;

/// Sorts units, removes duplicates, and keeps those of a sketch.
void sift(std::vector<std::uint32_t>& units) {
    std::sort(units.begin(), units.end());
    units.erase(std::unique(units.begin(), units.end()), units.end());
    if (units.size() <= kAtLeastKept) return;
    const std::uint32_t greatest = std::max(units[kAtLeastKept - 1], kAlwaysKept);
    units.erase(std::upper_bound(units.begin(), units.end(), greatest), units.end());
}

/// Returns the bound below which the sketch has all units.
std::uint32_t complete_to(const Sketch& sketch) {
    return sketch.size() < kAtLeastKept ? UINT32_MAX
                                        : std::max(sketch[kAtLeastKept - 1], kAlwaysKept);
}

std::string_view bytes_of(const std::uint32_t* bits, std::size_t n) {
    return {reinterpret_cast<const char*>(bits), 4 * n};
}

bool equal_in_common(const EpisodeContent& a, const EpisodeContent& b) {
    bool any = false;
    for (const auto& [name, content] : a) {
        const auto other = b.find(name);
        if (other == b.end()) continue;
        if (other->second.hash != content.hash) return false;
        any = true;
    }
    return any;
}

bool is_complete(const Sketch& sketch) {
    return sketch.size() < kAtLeastKept;
}

/// Returns the least share over the inputs that have enough units or, where none has, a few.
std::optional<double> share_in_common(const EpisodeContent& a, const EpisodeContent& b) {
    std::optional<double> least;
    std::optional<double> of_few;
    const auto take = [](std::optional<double>& all, std::optional<double> here) {
        if (here) all = std::min(all.value_or(1), *here);
    };
    for (const auto& [name, content] : a) {
        const auto other = b.find(name);
        if (other == b.end()) continue;
        const Sketch& there = other->second.sketch;
        take(least, share(content.sketch, there));
        if (is_complete(content.sketch) && is_complete(there))
            take(of_few, share(content.sketch, there, kFewestInCommon));
    }
    return least ? least : of_few;
}

}  // namespace

void ContentReader::add(const std::uint32_t* bits, std::size_t n, bool present) {
    const std::uint64_t sample = xxh64(bytes_of(bits, n));
    std::array<char, 8> bytes{};
    for (unsigned i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(sample >> (8 * i));
    hash_ = xxh64({bytes.data(), bytes.size()}, hash_);
    if (!tells_alone_)
        run_[steps_ % kRun] = n == 1 ? bits[0] : static_cast<std::uint32_t>(sample >> 32U);
    ++steps_;
    if (tells_alone_) {
        present_ += present ? 1 : 0;
        if (present) add_unit(sample);
    } else if (steps_ >= kRun && run_tells()) {
        std::array<std::uint32_t, kRun> in_order{};
        for (std::size_t i = 0; i < kRun; ++i) in_order[i] = run_[(steps_ + i) % kRun];
        add_unit(xxh64(bytes_of(in_order.data(), kRun)));
    }
}

bool ContentReader::run_tells() const {
    std::array<std::uint32_t, kRun> sorted = run_;
    std::sort(sorted.begin(), sorted.end());
    return std::unique(sorted.begin(), sorted.end()) - sorted.begin() >= std::ptrdiff_t{kRun / 2};
}

void ContentReader::add_unit(std::uint64_t hash) {
    constexpr std::size_t kRoom = 1024;
    const auto unit = static_cast<std::uint32_t>(hash >> 32U);
    if (unit > greatest_) return;
    units_.push_back(unit);
    if (units_.size() < room_) return;
    sift(units_);
    greatest_ = complete_to(units_);
    room_ = 2 * units_.size() + kRoom;
}

InputContent ContentReader::content() const {
    InputContent result;
    result.hash = fmt::format("{:016x}", xxh64(fmt::format("{} steps", steps_), hash_));
    result.sketch = units_;
    sift(result.sketch);
    // A few runs mostly repeat the same samples, and a few frequent samples are those of a world
    // with few images. A short episode has no more than a few.
    const bool is_short = tells_alone_ && present_ < kLeastUnits;
    if (!is_short && result.sketch.size() < kLeastUnits) result.sketch.clear();
    return result;
}

std::optional<double> share(const Sketch& a, const Sketch& b, std::size_t least_units) {
    const std::uint32_t end = std::min(complete_to(a), complete_to(b));
    const auto of_a = std::upper_bound(a.begin(), a.end(), end);
    const auto of_b = std::upper_bound(b.begin(), b.end(), end);
    const auto least = static_cast<std::size_t>(std::min(of_a - a.begin(), of_b - b.begin()));
    if (least < least_units) return std::nullopt;
    std::size_t common = 0;
    for (auto x = a.begin(), y = b.begin(); x != of_a && y != of_b;) {
        common += *x == *y ? 1 : 0;
        const bool first = *x <= *y;
        const bool second = *y <= *x;
        x += first ? 1 : 0;
        y += second ? 1 : 0;
    }
    return static_cast<double>(common) / static_cast<double>(least);
}

void EpisodesByKey::add(std::uint64_t key, std::uint32_t episode) {
    if (entries_.size() == first_.size()) grow();
    std::uint32_t& first = first_[slot(key)];
    entries_.push_back({key, episode, first});
    first = static_cast<std::uint32_t>(entries_.size() - 1);
}

void EpisodesByKey::grow() {
    first_.assign(std::max<std::size_t>(64, 2 * first_.size()), kNone);
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
        std::uint32_t& first = first_[slot(entries_[i].key)];
        entries_[i].next = first;
        first = i;
    }
}

void Recordings::add(const EpisodeContent& content) {
    const auto episode = static_cast<std::uint32_t>(all_.size());
    all_.push_back(content);
    for (const auto& [name, of_input] : content) {
        by_hash_[name].add(xxh64(of_input.hash), episode);
        EpisodesByKey& units = by_unit_[name];
        for (const std::uint32_t unit : of_input.sketch) units.add(unit, episode);
    }
}

std::optional<Overlap> Recordings::find(const EpisodeContent& content) const {
    std::set<std::uint32_t> perhaps;
    for (const auto& [name, of_input] : content) {
        const auto known = by_hash_.find(name);
        if (known == by_hash_.end()) continue;
        std::optional<std::uint32_t> equal;  // the first
        known->second.for_each(xxh64(of_input.hash), [&](std::uint32_t episode) {
            if (episode < equal.value_or(UINT32_MAX) && equal_in_common(content, all_[episode]))
                equal = episode;
        });
        if (equal) return Overlap{*equal, 1, true};
        std::unordered_map<std::uint32_t, std::uint32_t> in_common;
        const EpisodesByKey& units = by_unit_.at(name);
        const std::uint32_t fewest = fewest_in_common(of_input.sketch);
        const std::string& input = name;  // clang 14 captures no structured binding
        for (const std::uint32_t unit : of_input.sketch)
            units.for_each(unit, [&](std::uint32_t episode) {
                const Sketch& there = all_[episode].at(input).sketch;
                if (++in_common[episode] == std::min(fewest, fewest_in_common(there)))
                    perhaps.insert(episode);
            });
    }
    for (const std::uint32_t episode : perhaps) {
        const auto shared = share_in_common(content, all_[episode]);
        if (shared && *shared > 0.5) return Overlap{episode, *shared, false};
    }
    return std::nullopt;
}

}  // namespace etlc::data
