#include "prove/repetition.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace etlc::prove {

namespace {

/// Limits of what is kept: diagrams, and numbers in forms.
constexpr std::uint32_t kMostDiagrams = 10U << 20U;
constexpr std::uint32_t kMostToGoOn = 1U << 19U;  // more steps take too long
constexpr std::size_t kMostKept = 64U << 20U;

/// Where each value of a counter may have an effect of its own.
constexpr std::uint32_t kAll = 0xffffffffU;

}  // namespace

Repetition::Repetition(const plan::Plan& plan, const Definition& definition, const Proof& proof,
                       Space& space)
    : places_(proof.places),
      atoms_(proof.atoms),
      space_(space),
      unfolded_(plan, definition, space),
      images_(space.diagrams, proof.atoms.size()),
      why_not_(proof.why_not_longer) {
    std::uint32_t longest = 0;
    for (const plan::Stream& stream : plan.streams) longest = std::max(longest, stream.length);
    // What reaches far ahead at the start only is over at some step.
    forms_.push_back({longest + 1});
    if (unfolded_.depth() > longest) forms_.push_back({unfolded_.depth() + 1});
    if (why_not_.empty() && !unfolded_.fits()) why_not_ = "its formulas look too far ahead";
}

void Repetition::begin_step() {
    if (!is_over()) unfolded_.step();
}

void Repetition::check(std::uint32_t monitor, std::uint32_t position, const Numbers& expected) {
    if (!is_over() && unfolded_.verdict(monitor, position) != expected)
        why_not_ = "the definition, one step at a time, gives another verdict";
}

void Repetition::is_inexact(bool in_ranges) {
    if (in_ranges)
        needs_ranges_ = step_;
    else
        inexact_ = step_;
}

void Repetition::note(const State& state) {
    counted_.emplace_back();
    is_counting_ = false;
    for (const State::Word& word : state.words) {
        if (word.kind != etlprove::WordKind::counter) continue;
        counted_.back().push_back(word.counted);
        is_counting_ = is_counting_ || word.counted > word.value;
    }
    std::uint32_t oldest = step_;
    if (state.oldest_negated >= etlprove::kFirstSample)
        oldest = places_ - 1 -
                 static_cast<std::uint32_t>((state.oldest_negated - etlprove::kFirstSample) /
                                            (atoms_.size() * etlprove::kPlacesPerSample));
    negated_.push_back(oldest);
    controls_.emplace_back();
    for (const State::Word& word : state.words)
        controls_.back().push_back(word.kind == etlprove::WordKind::control ? word.value : 0);
}

void Repetition::look(Forms& forms, const State& state, const std::vector<Diagram>& diagrams) {
    const auto first_of = [&](std::uint32_t step) {
        return etlprove::place_of({step, places_}, 0, atoms_.size(), 0);
    };
    Form form(space_.diagrams, first_of(step_),
              step_ < forms.recent ? etlprove::kNoPlace : first_of(step_ - forms.recent));
    Seen now{step_, {}, {}};
    for (const State::Word& word : state.words) {
        if (word.kind == etlprove::WordKind::control) form.add_control(word.value);
        if (word.kind == etlprove::WordKind::diagram) form.add(word.value);
        if (word.kind != etlprove::WordKind::counter) continue;
        form.add_counter();
        now.counters.push_back(word.value);
    }
    for (const Diagram diagram : diagrams) form.add(diagram);
    now.leaves = form.leaves();
    auto& alike = forms.seen[form.numbers()];
    if (alike.empty()) kept_ += form.numbers().size();
    for (auto before = alike.rbegin(); before != alike.rend() && !is_over(); ++before)
        if (leads_to(forms, *before, now)) found_ = Repeats{before->step, step_};
    alike.push_back(std::move(now));
}

/// Whether all after `now` goes on as all after `before`, which has the same form.
bool Repetition::leads_to(const Forms& forms, const Seen& before, const Seen& now) {
    if (before.step < unfolded_.reach() || (inexact_ && *inexact_ > before.step)) return false;
    for (std::size_t n = 0; n < before.counters.size(); ++n)
        if (now.counters[n] < before.counters[n]) return false;
    for (std::uint32_t step = before.step + 1; step <= now.step; ++step) {
        if (counted_[step].size() != before.counters.size()) return false;
        for (std::size_t n = 0; n < before.counters.size(); ++n)
            if (counted_[step][n] > before.counters[n]) return false;
        // The negation of a function of older samples is not a function of its value.
        if (negated_[step] + forms.recent <= before.step) return false;
    }
    return take_equal_values(before, now);
}

/// Whether the functions of older samples do. Where verdicts are equal for samples in their ranges
/// only, those of such samples count too.
bool Repetition::take_equal_values(const Seen& before, const Seen& now) {
    if (images_.gives_up()) why_not_ = "its values of long ago have too many relations";
    if (!images_.are_equal(before.leaves, now.leaves, nullptr)) return false;
    if (!needs_ranges_ || *needs_ranges_ <= before.step) return true;
    for (const Images::Possible& possible : ends_in_ranges(space_, atoms_))
        if (!images_.are_equal(before.leaves, now.leaves, &possible)) return false;
    return true;
}

void Repetition::end_step(const State& state, const std::vector<Diagram>& compared_later) {
    note(state);
    if (!is_over() && state.words.empty()) why_not_ = "its members are not whole words";
    if (!is_over() && (space_.diagrams.size() > kMostDiagrams || kept_ > kMostKept))
        why_not_ = "the diagrams are too large";
    std::vector<Diagram> diagrams = compared_later;
    if (!is_over()) unfolded_.append_state(diagrams);
    for (Forms& forms : forms_)
        if (!is_over()) look(forms, state, diagrams);
    ++step_;
}

std::string Repetition::why_not() const {
    if (!why_not_.empty()) return why_not_;
    if (is_counting_) return "what it does depends on the number of the step";
    if (inexact_ && *inexact_ + 1 == step_)
        return "some verdicts are equal only for the samples that there can be";
    return "its state did not come back to a form that was seen";
}

/// Returns the period of the control words, as far as they show it.
std::uint32_t Repetition::period() const {
    std::uint32_t all = 1;
    for (std::size_t word = 0; word < controls_.back().size(); ++word) {
        std::uint32_t period = 1;
        const auto repeats = [&] {
            for (std::uint32_t step = std::max(period, step_ - step_ / 4); step < step_; ++step)
                if (controls_[step][word] != controls_[step - period][word]) return false;
            return true;
        };
        while (period < step_ && !repeats()) ++period;
        // What has not repeated yet may be in its first round.
        if (period < step_) all = std::lcm(all, period);
    }
    return all;
}

std::uint32_t Repetition::steps_needed() const {
    if (is_over() || controls_.empty()) return 0;
    std::uint32_t counted = 0;
    for (const std::uint32_t constant : counted_.back()) counted = std::max(counted, constant);
    if (counted == kAll) return 0;
    if (space_.diagrams.size() > kMostToGoOn) return 0;
    const std::uint32_t recent = forms_.back().recent;
    const std::uint64_t begin =
        std::max(std::uint64_t{5} * recent / 2, std::uint64_t{counted} + recent);
    const std::uint64_t needed = begin + period() + 2;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(needed, kAll));
}

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
Diagram Images::in_ranges(Diagram of, const Possible& possible, Cache& cache) {
    if (of <= kAlways) return of;
    if (const auto found = cache.find(of); found != cache.end()) return found->second;
    const etlprove::Diagrams::Node node = diagrams_[of];
    const bool may_be_false = may_be(possible, node.place, false);
    const bool may_be_true = may_be(possible, node.place, true);
    const Diagram without = may_be_false ? in_ranges(node.without, possible, cache) : kNever;
    const Diagram with = may_be_true ? in_ranges(node.with, possible, cache) : kNever;
    const Diagram result = !may_be_false  ? with
                           : !may_be_true ? without
                                          : diagrams_.choose(node.place, without, with);
    return cache.emplace(of, result).first->second;
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
    Cache cache;
    most_diagrams_ = diagrams_.size() + kMostDiagrams;
    is_too_large_ = false;
    for (const std::vector<std::size_t>& group : groups(first, second)) {
        first_.clear();
        second_.clear();
        agreed_.clear();
        for (const std::size_t n : group) {
            first_.push_back(possible ? in_ranges(first[n], *possible, cache) : first[n]);
            second_.push_back(possible ? in_ranges(second[n], *possible, cache) : second[n]);
        }
        if (first_ == second_ || agree(0, kAlways, kAlways)) continue;
        failures_ += is_too_large_ ? 1 : 0;
        return false;
    }
    return true;
}

}  // namespace etlc::prove
