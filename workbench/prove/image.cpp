#include "prove/image.hpp"

#include <algorithm>
#include <utility>

namespace etlc::prove {

using etlprove::kAlways;

/// The ends of atoms that a function depends on at some step.
const Images::Support& Images::support(Diagram of) {
    if (const auto found = supports_.find(of); found != supports_.end()) return found->second;
    Support result;
    if (of > kAlways) {
        const etlprove::Diagrams::Node node = diagrams_[of];
        result = support(node.without) | support(node.with);
        result.set((node.place - etlprove::kFirstSample) % places_ % result.size());
    }
    return supports_.emplace(of, result).first->second;
}

/// Returns groups that depend on different ends of atoms, and so take their values independently.
std::vector<std::vector<std::size_t>> Images::groups(const std::vector<Diagram>& first,
                                                     const std::vector<Diagram>& second) {
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

/// Null where there are too many.
const Images::Values* Images::values(const std::vector<Diagram>& of) {
    if (const auto found = values_.find(of); found != values_.end()) return &found->second;
    if (values_.size() >= kMostLists) return nullptr;
    Place top = etlprove::kNoPlace;
    for (const Diagram one : of) top = std::min(top, diagrams_[one].place);
    Values result;
    if (top == etlprove::kNoPlace) {
        std::vector<bool> all;
        for (const Diagram one : of) all.push_back(one == kAlways);
        result.insert(all);
    }
    for (const bool with : {false, true}) {
        if (top == etlprove::kNoPlace) break;
        std::vector<Diagram> part = of;
        for (Diagram& one : part)
            if (diagrams_[one].place == top) one = with ? diagrams_[one].with : diagrams_[one].without;
        const Values* const found = values(part);
        if (found == nullptr) return nullptr;
        result.insert(found->begin(), found->end());
        if (result.size() > kMostValues) return nullptr;
    }
    return &values_.emplace(of, std::move(result)).first->second;
}

bool Images::are_equal(const std::vector<Diagram>& first, const std::vector<Diagram>& second) {
    if (first.size() != second.size()) return false;
    values_.clear();
    for (const std::vector<std::size_t>& group : groups(first, second)) {
        std::vector<Diagram> some, others;
        for (const std::size_t n : group) {
            some.push_back(first[n]);
            others.push_back(second[n]);
        }
        const Values* const one = values(some);
        const Values* const other = one == nullptr ? nullptr : values(others);
        if (other == nullptr || *one != *other) return false;
    }
    return true;
}

}  // namespace etlc::prove
