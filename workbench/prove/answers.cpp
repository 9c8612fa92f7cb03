// Reads what the program says; stand_in/etlprove/output.hpp lists its entries.
#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "prove/program.hpp"

namespace etlc::prove {

void Answers::end() {
    const int status = child_.exit_status();
    throw Ended{status, child_.ending()};
}

std::uint32_t Answers::word() {
    char bytes[sizeof(std::uint32_t)];
    if (!child_.read(bytes, sizeof bytes)) end();
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

Diagram Answers::known(std::uint32_t theirs) const {
    const auto found = known_.find(theirs);
    if (found == known_.end()) throw Ended{0, "contradicts itself"};
    return found->second;
}

Answers::Entry Answers::next() {
    for (;;) {
        const auto entry = static_cast<Entry>(word());
        if (entry == Entry::number) throw NewNumber{std::bit_cast<float>(word())};
        if (entry != Entry::node) return entry;
        const std::uint32_t theirs = word();
        const Place place = word();
        const Diagram without = known(word());
        const Diagram with = known(word());
        known_[theirs] = space_.diagrams.choose(place, without, with);
    }
}

Said Answers::verdict() {
    Said said;
    said.may_be_missing = word() == 1;
    for (std::uint32_t* const field : {&said.monitor, &said.step, &said.finishes}) *field = word();
    said.numbers.decided = word() == 1;
    for (std::size_t m = 0; m < monitors_; ++m) said.begun.push_back(word());
    Numbers& numbers = said.numbers;
    for (Diagram* const field : {&numbers.low, &numbers.high, &numbers.lower, &numbers.upper,
                                 &said.satisfied, &said.violated, &said.final})
        *field = known(word());
    return said;
}

State Answers::state() {
    State state;
    for (std::uint32_t count = word(); count > 0; --count) {
        State::Word next;
        next.kind = static_cast<State::Kind>(word());
        next.value = word();
        next.counted = word();
        if (next.kind == State::Kind::diagram) next.value = known(next.value);
        state.words.push_back(next);
    }
    state.oldest_negated = word();
    return state;
}

Window Answers::window() {
    Window window;
    window.length = word();
    const std::uint32_t answer = word();
    window.is_two_windows = answer == 1;
    window.is_too_long = answer == 2;
    return window;
}

std::string why(const Ended& ended) {
    switch (ended.status) {  // as stand_in/etlprove/space.hpp has them
        case 10: return "the class compares two values and branches on the result";
        case 11: return "the diagrams of the class are too large";
        case 13: return "the class has too many states and ways through a step";
        case 14: return "the class keeps something after reset(), or after a restart";
        case 15: return "a verdict may depend on what the class counts for telemetry";
        case 16: return "step() does something else than measure() and judge() one after the other";
        case 17: return "the class gives a verdict or an atom the name of another";
        case 18:
            return "after a final verdict the class does something else than to count it and to "
                   "restart that monitor";
        default: return "the class, compiled for the proof, " + ended.how;
    }
}

}  // namespace etlc::prove
