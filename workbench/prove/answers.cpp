// Reads what the program says; stand_in/etlprove/driver.hpp writes it.
#include <bit>
#include <cstring>

#include "prove/program.hpp"

namespace etlc::prove {

namespace {

enum Entry : std::uint32_t { kNumber = 1, kNode, kVerdict, kReset, kWindow, kEnd, kState };

/// The exit statuses of the program, as stand_in/etlmon/temporal/value.hpp has them.
constexpr int kBranches = 10;
constexpr int kExhausted = 11;

}  // namespace

void Answers::end() {
    const int status = child_.exit_status();
    if (status == kBranches) throw Ended{Ended::Why::branches, ""};
    if (status == kExhausted) throw Ended{Ended::Why::exhausted, ""};
    throw Ended{Ended::Why::failed, child_.ending()};
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
    if (found == known_.end()) throw Ended{Ended::Why::failed, "contradicts itself"};
    return found->second;
}

std::uint32_t Answers::next() {
    for (;;) {
        const std::uint32_t kind = word();
        if (kind == kNumber) throw NewNumber{std::bit_cast<float>(word())};
        if (kind != kNode) return kind;
        const std::uint32_t theirs = word();
        const Place place = word();
        const Diagram without = known(word());
        const Diagram with = known(word());
        known_[theirs] = space_.diagrams.choose(place, without, with);
    }
}

Numbers Answers::verdict() {
    if (next() != kVerdict) end();
    Numbers numbers;
    numbers.decided = word() == 1;
    Diagram* const fields[] = {&numbers.low, &numbers.high, &numbers.lower, &numbers.upper};
    for (Diagram* const field : fields) {
        const std::uint32_t theirs = word();
        if (numbers.decided) *field = known(theirs);
    }
    return numbers;
}

bool Answers::forgotten() {
    if (next() != kReset) end();
    return word() == 1;
}

std::optional<Window> Answers::window() {
    const std::uint32_t kind = next();
    if (kind == kEnd) return std::nullopt;
    if (kind != kWindow) end();
    Window window;
    window.length = word();
    const std::uint32_t answer = word();
    window.is_two_windows = answer == 1;
    window.is_too_long = answer == 2;
    return window;
}

State Answers::state() {
    if (next() != kState) end();
    State state;
    for (std::uint32_t count = word(); count > 0; --count) {
        const std::uint32_t kind = word(), value = word();
        if (kind > static_cast<std::uint32_t>(State::Kind::counter)) end();
        state.words.push_back({static_cast<State::Kind>(kind), value});
        State::Word& last = state.words.back();
        if (last.kind == State::Kind::diagram) last.value = known(value);
    }
    state.counted = word();
    state.oldest_negated = word();
    return state;
}

}  // namespace etlc::prove
