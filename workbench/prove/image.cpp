#include "prove/image.hpp"

#include <algorithm>
#include <utility>

namespace etlc::prove {

using etlprove::kAlways;
using etlprove::kFirstSample;
using etlprove::kNoPlace;
using etlprove::kPlacesPerSample;

/// The ends of atoms that a function depends on at some step.
const Images::Support& Images::support(Diagram of) {
    if (const auto found = supports_.find(of); found != supports_.end()) return found->second;
    Support result;
    if (of > kAlways) {
        const etlprove::Diagrams::Node node = diagrams_[of];
        result = support(node.without) | support(node.with);
        result.set((node.place - kFirstSample) % (atoms_ * kPlacesPerSample) % result.size());
    }
    return supports_.emplace(of, result).first->second;
}

/// Returns groups that depend on different ends of atoms, and so take their values independently.
std::vector<std::vector<std::size_t>> Images::groups(const Functions& first,
                                                     const Functions& second) {
    std::vector<std::pair<Support, std::vector<std::size_t>>> groups;
    for (std::size_t n = 0; n < first.size(); ++n) {
        std::pair<Support, std::vector<std::size_t>> joined{support(first[n]) | support(second[n]),
                                                            {n}};
        for (std::size_t g = groups.size(); g-- > 0;) {
            if ((groups[g].first & joined.first).none()) continue;
            joined.first |= groups[g].first;
            joined.second.insert(joined.second.end(), groups[g].second.begin(),
                                 groups[g].second.end());
            groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(g));
        }
        groups.push_back(std::move(joined));
    }
    std::vector<std::vector<std::size_t>> result;
    for (auto& [support, group] : groups) result.push_back(std::move(group));
    return result;
}

bool Images::may_be(Place place, bool is_true) const {
    if (possible_ == nullptr) return true;
    const Place at = place - kFirstSample;
    for (std::uint32_t ends = 0; ends < 1U << kPlacesPerSample; ++ends)
        if (((*possible_)[at / kPlacesPerSample % atoms_] >> ends & 1U) != 0 &&
            ((ends >> at % kPlacesPerSample & 1U) != 0) == is_true)
            return true;
    return false;
}

/// Null where there are too many.
const Images::Values* Images::values(const Functions& of) {
    if (const auto found = values_.find(of); found != values_.end()) return &found->second;
    if (values_.size() >= kMostLists) return nullptr;
    Place top = kNoPlace;
    for (const Diagram one : of) top = std::min(top, diagrams_[one].place);
    Values result;
    if (top == kNoPlace) {
        std::vector<bool> all;
        for (const Diagram one : of) all.push_back(one == kAlways);
        result.insert(all);
        return &values_.emplace(of, std::move(result)).first->second;
    }
    for (const bool is_true : {false, true}) {
        if (!may_be(top, is_true)) continue;
        Functions branch = of;
        for (Diagram& one : branch)
            if (const auto& node = diagrams_[one]; node.place == top)
                one = is_true ? node.with : node.without;
        const Values* const found = values(branch);
        if (found == nullptr) return nullptr;
        result.insert(found->begin(), found->end());
        if (result.size() > kMostValues) return nullptr;
    }
    return &values_.emplace(of, std::move(result)).first->second;
}

bool Images::are_equal(const Functions& first, const Functions& second, const Possible* possible) {
    if (first.size() != second.size()) return false;
    possible_ = possible;
    for (const std::vector<std::size_t>& group : groups(first, second)) {
        Functions some, others;
        for (const std::size_t n : group) {
            some.push_back(first[n]);
            others.push_back(second[n]);
        }
        if (some == others) continue;
        values_.clear();
        const Values* const one = values(some);
        const Values* const other = one == nullptr ? nullptr : values(others);
        if (other == nullptr) ++failures_;
        if (other == nullptr || *one != *other) return false;
    }
    return true;
}

}  // namespace etlc::prove
