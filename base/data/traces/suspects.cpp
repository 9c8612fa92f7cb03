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
#include "data/traces/suspects.hpp"

#include <algorithm>
#include <optional>

#include "data/files/hash.hpp"

namespace etlc::data {

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
