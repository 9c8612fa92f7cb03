// Reads what the program says; stand_in/etlprove/output.hpp lists its entries.
#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "prove/program.hpp"

namespace etlc::prove {

namespace {

enum Entry : std::uint32_t {
    kNumber = 1,
    kNode,
    kVerdict,
    kReset,
    kTogether,
    kWindow,
    kEnd,
    kStatus,
    kFinished,
    kState
};

/// The exit statuses of the program, as stand_in/etlprove/space.hpp has them.
constexpr int kBranches = 10;
constexpr int kExhausted = 11;
constexpr int kTooMany = 13;
constexpr int kLeftovers = 14;

}  // namespace

void Answers::end() {
    const int status = child_.exit_status();
    if (status == kBranches) throw Ended{Ended::Why::branches, ""};
    if (status == kExhausted) throw Ended{Ended::Why::exhausted, ""};
    if (status == kLeftovers) throw Ended{Ended::Why::leftovers, ""};
    if (status == kTooMany) throw Ended{Ended::Why::too_many, ""};
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

Together Answers::together() {
    if (next() != kTogether) end();
    const std::uint32_t steps = word();
    return {steps, word() == 1};
}

std::optional<Status> Answers::status() {
    const std::uint32_t kind = next();
    if (kind == kFinished) return std::nullopt;
    if (kind != kStatus) end();
    Status status;
    status.begun = word();
    Diagram* const fields[] = {&status.condition, &status.satisfied, &status.violated,
                               &status.decided, &status.final};
    for (Diagram* const field : fields) *field = known(word());
    return status;
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

std::string why(const Ended& ended) {
    switch (ended.why) {
        case Ended::Why::branches:
            return "the class compares two values and branches on the result";
        case Ended::Why::exhausted: return "the diagrams of the class are too large";
        case Ended::Why::too_many: return "the class has too many states and cases of a step";
        case Ended::Why::leftovers:
        case Ended::Why::failed: break;
    }
    return fmt::format("the class, compiled for the proof, {}", ended.how);
}

std::string how_far(std::uint32_t steps) {
    return steps == 0 ? ""
                      : fmt::format("; it is right for all inputs of up to {}",
                                    diag::counted(steps, "step"));
}

}  // namespace etlc::prove
