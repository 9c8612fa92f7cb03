#include "data/traces/overlap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

#include "data/files/hash.hpp"
#include "data/spill/spill.hpp"

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

std::uint64_t hash_of(std::uint64_t number, std::uint64_t seed) {
    std::array<char, 8> bytes{};
    for (unsigned i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(number >> (8 * i));
    return xxh64({bytes.data(), bytes.size()}, seed);
}

bool is_complete(const Sketch& sketch) {
    return sketch.size() < kAtLeastKept;
}

/// One input's answer about two episodes.
struct Verdict {
    enum class Kind : std::uint8_t { nothing, different, same };
    Kind kind = Kind::nothing;
    double share = 0;  ///< `same`: in common
};

/// Compares the units of an embedding: a few are enough only if all of both are compared.
Verdict by_units(const Sketch& a, const Sketch& b) {
    const auto all = share(a, b, 1);
    if (!all) return {};
    if (*all <= 0.5) return {Verdict::Kind::different};
    const std::size_t least = is_complete(a) && is_complete(b) ? kFewestInCommon : kLeastUnits;
    return share(a, b, least) ? Verdict{Verdict::Kind::same, *all} : Verdict{};
}

Verdict verdict(const InputContent& a, const InputContent& b) {
    const Verdict by_samples = by_units(a.sketch, b.sketch);
    const bool both_recur = a.samples == Samples::recurring && b.samples == Samples::recurring;
    if (by_samples.kind == Verdict::Kind::different || !both_recur) return by_samples;
    return by_units(a.changes, b.changes);
}

/// Calls `visit(a, b)` with the contents of each input that both have.
template <class Visit>
void for_each_common(const EpisodeContent& a, const EpisodeContent& b, const Visit& visit) {
    for (const auto& [name, content] : a)
        if (const auto other = b.find(name); other != b.end()) visit(content, other->second);
}

bool equal_in_common(const EpisodeContent& a, const EpisodeContent& b) {
    bool any = false;
    bool all_equal = true;
    bool embeddings_equal = true;
    bool embedding_tells = false;
    for_each_common(a, b, [&](const InputContent& one, const InputContent& other) {
        const bool equal = one.hash == other.hash;
        const bool of_embedding = one.samples != Samples::runs;
        any = true;
        all_equal &= equal;
        embeddings_equal &= equal || !of_embedding;
        embedding_tells |= of_embedding && verdict(one, other).kind == Verdict::Kind::same;
    });
    return any && (all_equal || (embeddings_equal && embedding_tells));
}

/// Returns the share that makes two episodes parts of one recording; nothing if they are not.
std::optional<double> share_in_common(const EpisodeContent& a, const EpisodeContent& b) {
    std::optional<double> of_embeddings;  // the greatest
    std::optional<double> of_scalars;     // the least
    bool differ = false;
    for_each_common(a, b, [&](const InputContent& one, const InputContent& other) {
        if (one.samples == Samples::runs) {
            if (const auto here = share(one.sketch, other.sketch))
                of_scalars = std::min(of_scalars.value_or(1), *here);
            return;
        }
        const Verdict found = verdict(one, other);
        differ |= found.kind == Verdict::Kind::different;
        if (found.kind == Verdict::Kind::same)
            of_embeddings = std::max(of_embeddings.value_or(0), found.share);
    });
    if (of_embeddings) return of_embeddings;
    return !differ && of_scalars && *of_scalars > 0.5 ? of_scalars : std::nullopt;
}

}  // namespace

void ContentReader::add(const std::uint32_t* bits, std::size_t n, bool present) {
    const std::uint64_t sample = xxh64(bytes_of(bits, n));
    hash_ = hash_of(sample, hash_);
    if (!tells_alone_)
        run_[steps_ % kRun] = n == 1 ? bits[0] : static_cast<std::uint32_t>(sample >> 32U);
    ++steps_;
    if (tells_alone_) {
        present_ += present ? 1 : 0;
        if (present) units_.add(sample);
        follow(sample, present);
    } else if (steps_ >= kRun && run_tells()) {
        std::array<std::uint32_t, kRun> in_order{};
        for (std::size_t i = 0; i < kRun; ++i) in_order[i] = run_[(steps_ + i) % kRun];
        units_.add(xxh64(bytes_of(in_order.data(), kRun)));
    }
}

void ContentReader::follow(std::uint64_t sample, bool present) {
    if (different_.size() == kManySamples) return;
    if (steps_ > 1 && stay_.sample == sample) {
        ++stay_.steps;
        return;
    }
    if (present && std::find(different_.begin(), different_.end(), sample) == different_.end())
        different_.push_back(sample);
    const Stay before = stay_;
    stay_ = {sample, 1};
    if (steps_ - 1 == before.steps) return;  // the first, whose begin was not seen
    if (earlier_.size() == kRun) earlier_.erase(earlier_.begin());
    earlier_.push_back(before);
    std::uint64_t steps = 0;
    std::uint64_t unit = sample;
    for (std::size_t i = earlier_.size(); i-- > 0 && steps < kRun; steps += earlier_[i].steps)
        unit = hash_of(earlier_[i].steps, hash_of(earlier_[i].sample, unit));
    if (steps >= kRun) changes_.add(unit);
}

bool ContentReader::run_tells() const {
    std::array<std::uint32_t, kRun> sorted = run_;
    std::sort(sorted.begin(), sorted.end());
    return std::unique(sorted.begin(), sorted.end()) - sorted.begin() >= std::ptrdiff_t{kRun / 2};
}

void Sketching::add(std::uint64_t hash) {
    constexpr std::size_t kRoom = 1024;
    const auto unit = static_cast<std::uint32_t>(hash >> 32U);
    if (unit > greatest_) return;
    units_.push_back(unit);
    if (units_.size() < room_) return;
    sift(units_);
    greatest_ = complete_to(units_);
    room_ = 2 * units_.size() + kRoom;
}

Sketch Sketching::sketch() const {
    Sketch result = units_;
    sift(result);
    return result;
}

InputContent ContentReader::content() const {
    InputContent result;
    result.hash = fmt::format("{:016x}", xxh64(fmt::format("{} steps", steps_), hash_));
    result.sketch = units_.sketch();
    if (!tells_alone_) {
        // A few runs mostly repeat the same samples.
        if (result.sketch.size() < kLeastUnits) result.sketch.clear();
        return result;
    }
    const std::size_t different = different_.size();
    const bool recurs = different < kManySamples && present_ >= 2 * different;
    result.samples = recurs ? Samples::recurring : Samples::apart;
    if (recurs) result.changes = changes_.sketch();
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
        if (of_input.sketch.size() < kFewestInCommon) continue;
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
        if (of_input.sketch.size() < kFewestInCommon) continue;
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
        if (const auto shared = share_in_common(content, all_[episode]))
            return Overlap{episode, *shared, false};
    }
    return std::nullopt;
}

void KnownEpisodes::add(std::uint64_t hash, const EpisodeContent& content) {
    if (all_ == nullptr) all_ = std::make_shared<All>();
    if (all_.use_count() > 1) {
        KnownEpisodes mine;
        for_each([&](std::uint64_t known, const EpisodeContent& of) { mine.add(known, of); });
        *this = std::move(mine);
        if (all_ == nullptr) all_ = std::make_shared<All>();
    }
    all_->places.add({hash, all_->contents.size()});
    all_->contents.add(content);
}

void KnownEpisodes::for_each(const Visit& visit) const {
    if (all_ == nullptr) return;
    const std::shared_ptr<All> all = all_;  // which `visit` may change
    std::optional<Place> last;
    const auto pass_on = [&] {
        if (last) visit(last->hash, all->contents[last->at]);
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

// Two episodes are compared if one is asked about and the other known, or if both are asked about
// and `each_other` is set. `Recordings` finds one by the other only if an input of both has the
// same hash, or enough units in common: 2 if one of them has few units, else 5. In the first case
// both are in the group of that hash. In the second case some of the common units occur in few
// episodes; these are counted for each pair (`few`). The number of other common units is at most
// the number of frequent units that each of the two has. So if the units are enough, few + the
// lesser of these two numbers is enough, or few is 0 and both numbers are enough: both episodes
// become suspects. 2 count as enough if some episode that has them has few units. Recordings finds
// the same among the suspects as among all episodes, since its result depends on the order only,
// which suspects keep.

namespace {

/// Calls `visit(group)` for the values that `is_same` says are of one group with the value before.
template <class Value, class Same, class Visit>
void for_each_group(Sorted<Value>& all, const Same& is_same, const Visit& visit) {
    std::vector<std::uint32_t> episodes;
    Value first{};
    all.for_each([&](const Value& value) {
        if (!episodes.empty() && !is_same(first, value)) {
            visit(first, episodes);
            episodes.clear();
        }
        if (episodes.empty()) first = value;
        episodes.push_back(value.episode);
    });
    if (!episodes.empty()) visit(first, episodes);
}

constexpr std::size_t kFew = 8;  ///< episodes, which make 28 pairs

/// The units of one input that episodes have in common.
class InCommon {
public:
    /// `is_short`: episodes with few units; must outlive this.
    explicit InCommon(const std::vector<bool>& is_short)
        : is_short_(is_short), widely_(is_short.size()) {}

    /// Two episodes have a unit that is rare.
    void add_pair(std::uint32_t a, std::uint32_t b) { pairs_.add({a, b}); }
    /// An episode has a unit that is frequent.
    void add_wide(std::uint32_t episode) {
        if (widely_[episode] < kEnough) ++widely_[episode];
    }

    void find(std::vector<bool>& suspects) {
        bool any_short = false;
        for (std::size_t e = 0; e < widely_.size(); ++e)
            any_short = any_short || (is_short_[e] && widely_[e] >= kFewestInCommon);
        for (std::size_t e = 0; e < widely_.size(); ++e)
            if (widely_[e] >= (any_short ? kFewestInCommon : kEnough)) suspects[e] = true;
        Pair last{};
        std::uint32_t few = 0;
        pairs_.for_each([&](const Pair& pair) {
            few = pair.a == last.a && pair.b == last.b ? few + 1 : 1;
            last = pair;
            const bool of_short = is_short_[pair.a] || is_short_[pair.b];
            const std::uint32_t enough = of_short ? kFewestInCommon : kEnough;
            if (few + std::min(widely_[pair.a], widely_[pair.b]) < enough) return;
            suspects[pair.a] = true;
            suspects[pair.b] = true;
        });
    }

private:
    struct Pair {
        std::uint32_t a;
        std::uint32_t b;
        bool operator<(const Pair& other) const { return a != other.a ? a < other.a : b < other.b; }
    };
    static constexpr std::uint32_t kEnough = kLeastUnits / 2 + 1;

    const std::vector<bool>& is_short_;
    std::vector<std::uint8_t> widely_;  ///< number of frequent units, up to enough
    Sorted<Pair> pairs_;
};

}  // namespace

void Suspects::add(const EpisodeContent& content, bool is_known) {
    const auto episode = static_cast<std::uint32_t>(is_known_.size());
    is_known_.push_back(is_known);
    is_short_.push_back(false);
    for (const auto& [name, of_input] : content) {
        const auto next = static_cast<std::uint32_t>(inputs_.size());
        const std::uint32_t input = inputs_.try_emplace(name, next).first->second;
        hashes_.add({xxh64(of_input.hash), input, episode});
        const std::size_t units = of_input.sketch.size();
        if (units >= kFewestInCommon && units < kLeastUnits) is_short_.back() = true;
        for (const std::uint32_t unit : of_input.sketch) units_.add({unit, input, episode});
    }
}

template <class Visit>
void Suspects::for_each_shared(const std::vector<std::uint32_t>& same, const Visit& visit) const {
    if (same.size() < 2) return;
    const auto known = static_cast<std::size_t>(
        std::count_if(same.begin(), same.end(), [&](std::uint32_t e) { return is_known_[e]; }));
    const std::size_t asked = same.size() - known;
    const bool shares_asked = known > 0 || (each_other_ && asked > 1);
    for (const std::uint32_t episode : same)
        if (is_known_[episode] ? asked > 0 : shares_asked) visit(episode);
}

std::vector<bool> Suspects::find() {
    std::vector<bool> found(is_known_.size());
    const auto is_same = [](const Key& a, const Key& b) {
        return a.input == b.input && a.key == b.key;
    };
    for_each_group(hashes_, is_same, [&](const Key&, const std::vector<std::uint32_t>& same) {
        for_each_shared(same, [&](std::uint32_t episode) { found[episode] = true; });
    });
    std::optional<InCommon> in_common;
    std::uint32_t input = 0;
    const auto conclude = [&] {
        if (in_common) in_common->find(found);
    };
    for_each_group(units_, is_same, [&](const Key& unit, const std::vector<std::uint32_t>& same) {
        if (!in_common || unit.input != input) {
            conclude();
            in_common.emplace(is_short_);
            input = unit.input;
        }
        if (same.size() > kFew)
            return for_each_shared(same, [&](std::uint32_t e) { in_common->add_wide(e); });
        for (std::size_t i = 0; i < same.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (are_compared(same[k], same[i])) in_common->add_pair(same[k], same[i]);
    });
    conclude();
    return found;
}

}  // namespace etlc::data
