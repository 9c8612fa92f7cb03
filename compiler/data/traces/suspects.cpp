// Two episodes are compared where one of them is asked about and the other known, or both are asked
// about and those are looked for among each other. `Recordings` finds one by the other only where
// they have an input of the same hash, or an input with kFewestInCommon units in common: it looks
// at no others. In the first case each is in the other's group of that hash; in the second each of
// these units is one that the other has too. So the conditions here, that an episode shares a hash,
// or that many units of one input, with *any* others, hold for both. That Recordings then finds the
// same among the suspects as among all follows: it finds the first by order, and they keep theirs.
#include "data/traces/suspects.hpp"

#include <algorithm>

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

}  // namespace

void Suspects::add(const EpisodeContent& content, bool is_known) {
    const auto episode = static_cast<std::uint32_t>(is_known_.size());
    is_known_.push_back(is_known);
    for (const auto& [name, of_input] : content) {
        const auto next = static_cast<std::uint32_t>(inputs_.size());
        const std::uint32_t input = inputs_.try_emplace(name, next).first->second;
        hashes_.add({xxh64(of_input.hash), input, episode});
        for (const std::uint32_t unit : of_input.sketch) units_.add({input, unit, episode});
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
    for_each_group(
        hashes_, [](const Key& a, const Key& b) { return a.input == b.input && a.key == b.key; },
        [&](const Key&, const std::vector<std::uint32_t>& same) {
            for_each_shared(same, [&](std::uint32_t episode) { found[episode] = true; });
        });
    std::vector<std::uint8_t> in_common(found.size());  // units of this input, up to enough
    std::uint32_t input = 0;
    for_each_group(
        units_, [](const Unit& a, const Unit& b) { return a.input == b.input && a.unit == b.unit; },
        [&](const Unit& unit, const std::vector<std::uint32_t>& same) {
            if (unit.input != input) std::fill(in_common.begin(), in_common.end(), 0);
            input = unit.input;
            for_each_shared(same, [&](std::uint32_t episode) {
                if (in_common[episode] == kFewestInCommon) return;
                if (++in_common[episode] == kFewestInCommon) found[episode] = true;
            });
        });
    return found;
}

}  // namespace etlc::data
