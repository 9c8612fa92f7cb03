#include "prove/repetition.hpp"

#include <algorithm>
#include <utility>

namespace etlc::prove {
namespace {

/// Limits of what is kept: diagrams, and numbers of forms.
constexpr std::uint32_t kMostDiagrams = 10U << 20U;
constexpr std::size_t kMostKept = 64U << 20U;

}  // namespace

Repetition::Repetition(const plan::Plan& plan, const Definition& definition, std::uint32_t steps,
                       std::size_t atoms, Space& space, std::string why_not)
    : steps_(steps),
      places_(static_cast<Place>(atoms) * etlprove::kPlacesPerSample),
      space_(space),
      unfolded_(plan, definition, space),
      images_(space.diagrams, places_),
      why_not_(std::move(why_not)) {
    recent_ = unfolded_.depth();
    for (const plan::Stream& stream : plan.streams) recent_ = std::max(recent_, stream.length);
    ++recent_;
    if (why_not_.empty() && !unfolded_.fits()) why_not_ = "its formulas look too far ahead";
}

Place Repetition::first_place(std::uint32_t step) const {
    return etlprove::place_of({step, steps_}, 0, places_ / etlprove::kPlacesPerSample, 0);
}

void Repetition::begin_step() {
    if (!is_over()) unfolded_.step();
}

void Repetition::check(std::uint32_t monitor, std::uint32_t position, const Numbers& expected) {
    if (!is_over() && unfolded_.verdict(monitor, position) != expected)
        why_not_ = "the definition, one step at a time, gives another verdict";
}

void Repetition::is_inexact() {
    spoil("some verdicts are equal only for the samples that there can be");
}

void Repetition::spoil(const char* why) {
    spoilt_ = step_;
    why_spoilt_ = why;
}

void Repetition::note(const State& state) {
    if (state.counted) spoil("what it does depends on the number of the step");
    std::uint32_t oldest = step_;
    if (state.oldest_negated >= etlprove::kFirstSample)
        oldest = steps_ - 1 - (state.oldest_negated - etlprove::kFirstSample) / places_;
    negated_.push_back(oldest);
}

Form Repetition::form(const State& state, const std::vector<Diagram>& compared_later) {
    const Place older =
        step_ < recent_ ? etlprove::kNoPlace : first_place(step_ - recent_);
    Form form(space_.diagrams, first_place(step_), older);
    for (const State::Word& word : state.words) {
        if (word.kind == State::Kind::control) form.add_control(word.value);
        if (word.kind == State::Kind::counter) form.add_counter();
        if (word.kind == State::Kind::diagram) form.add(word.value);
    }
    std::vector<Diagram> more = compared_later;
    unfolded_.append_state(more);
    for (const Diagram diagram : more) form.add(diagram);
    return form;
}

/// Whether all after `now` goes on as all after `before`, which has the same form.
bool Repetition::leads_to(const Seen& before, const Seen& now) {
    if (before.step < unfolded_.reach() || (spoilt_ && *spoilt_ > before.step)) return false;
    // "A greater value would have the same effect", of each counter.
    for (std::size_t n = 0; n < before.counters.size(); ++n)
        if (now.counters[n] < before.counters[n]) return false;
    // The negation of a function of older samples is not a function of its value.
    for (std::uint32_t step = before.step + 1; step <= now.step; ++step)
        if (negated_[step] + recent_ <= before.step) return false;
    return images_.are_equal(before.leaves, now.leaves);
}

void Repetition::end_step(const State& state, const std::vector<Diagram>& compared_later) {
    note(state);
    if (!is_over() && state.words.empty()) why_not_ = "its members are not whole words";
    if (!is_over() && (space_.diagrams.size() > kMostDiagrams || kept_ > kMostKept))
        why_not_ = "the diagrams are too large";
    if (!is_over()) {
        const Form now = form(state, compared_later);
        Seen seen{step_, now.leaves(), {}};
        for (const State::Word& word : state.words)
            if (word.kind == State::Kind::counter) seen.counters.push_back(word.value);
        auto& alike = seen_[now.numbers()];
        if (alike.empty()) kept_ += now.numbers().size();
        for (auto before = alike.rbegin(); before != alike.rend() && !found_; ++before)
            if (leads_to(*before, seen)) found_ = Repeats{before->step, step_};
        alike.push_back(std::move(seen));
    }
    ++step_;
}

std::string Repetition::why_not() const {
    if (!why_not_.empty()) return why_not_;
    return spoilt_ && *spoilt_ + 1 == step_
               ? why_spoilt_
               : "its state did not come back to a form that was seen";
}

}  // namespace etlc::prove
