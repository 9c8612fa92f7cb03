#include "prove/lengths/image.hpp"

#include <algorithm>
#include <utility>

namespace etlc::prove {

using etlprove::kAlways;
using etlprove::kFirstSample;
using etlprove::kNever;
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

bool Images::may_be(const Possible& possible, Place place, bool is_true) const {
    const Place at = place - kFirstSample;
    for (std::uint32_t ends = 0; ends < 1U << kPlacesPerSample; ++ends)
        if ((possible[at / kPlacesPerSample % atoms_] >> ends & 1U) != 0 &&
            ((ends >> at % kPlacesPerSample & 1U) != 0) == is_true)
            return true;
    return false;
}

/// The function, where each end is what it may be.
Diagram Images::in_ranges(Diagram of, const Possible& possible, Known& known) {
    if (of <= kAlways) return of;
    if (const auto found = known.find(of); found != known.end()) return found->second;
    const etlprove::Diagrams::Node node = diagrams_[of];
    const bool may_be_false = may_be(possible, node.place, false);
    const bool may_be_true = may_be(possible, node.place, true);
    const Diagram without = may_be_false ? in_ranges(node.without, possible, known) : kNever;
    const Diagram with = may_be_true ? in_ranges(node.with, possible, known) : kNever;
    const Diagram result = !may_be_false  ? with
                           : !may_be_true ? without
                                          : diagrams_.choose(node.place, without, with);
    return known.emplace(of, result).first->second;
}

/// Whether both lists from n on take the same values together, where these conditions hold.
bool Images::agree(std::size_t n, Diagram one, Diagram other) {
    if (n == first_.size() || agreed_.contains({n, one, other})) return true;
    if (agreed_.size() >= kMostBranches || diagrams_.size() > most_diagrams_) {
        is_too_large_ = true;
        return false;
    }
    const Diagram ones[] = {first_[n], diagrams_.complement(first_[n])};
    const Diagram others[] = {second_[n], diagrams_.complement(second_[n])};
    for (const std::size_t value : {0, 1}) {
        const Diagram here = diagrams_.both(one, ones[value]);
        const Diagram there = diagrams_.both(other, others[value]);
        if ((here == kNever) != (there == kNever)) return false;
        if (here != kNever && !agree(n + 1, here, there)) return false;
    }
    agreed_.insert({n, one, other});
    return true;
}

bool Images::are_equal(const Functions& first, const Functions& second, const Possible* possible) {
    if (first.size() != second.size()) return false;
    Known known;
    most_diagrams_ = diagrams_.size() + kMostDiagrams;
    is_too_large_ = false;
    for (const std::vector<std::size_t>& group : groups(first, second)) {
        first_.clear();
        second_.clear();
        agreed_.clear();
        for (const std::size_t n : group) {
            first_.push_back(possible ? in_ranges(first[n], *possible, known) : first[n]);
            second_.push_back(possible ? in_ranges(second[n], *possible, known) : second[n]);
        }
        if (first_ == second_ || agree(0, kAlways, kAlways)) continue;
        failures_ += is_too_large_ ? 1 : 0;
        return false;
    }
    return true;
}

}  // namespace etlc::prove
