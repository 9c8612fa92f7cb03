// Reads what the program says; stand_in/etlprove/driver.hpp writes it.
#include <bit>
#include <cstring>

#include "prove/program.hpp"

namespace etlc::prove {

namespace {

enum Entry : std::uint32_t { kNumber = 1, kNode, kVerdict, kReset, kRepeats, kEnd };

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
    etlprove::Diagrams& diagrams = space_.diagrams;
    for (;;) {
        const std::uint32_t kind = word();
        if (kind == kNumber) {
            const float number = std::bit_cast<float>(word());
            for (const float signed_number : {number, -number})
                numbers_.push_back(space_.numbers.at_least(diagrams, signed_number));
            continue;
        }
        if (kind != kNode) return kind;
        const std::uint32_t theirs = word();
        const Place place = word();
        const Diagram without = known(word());
        const Diagram with = known(word());
        const bool is_number = place >= etlprove::kFirstNumber && place < etlprove::kFirstSample;
        if (is_number && place - etlprove::kFirstNumber >= numbers_.size())
            throw Ended{Ended::Why::failed, "contradicts itself"};
        const Place ours =
            is_number ? diagrams[numbers_[place - etlprove::kFirstNumber]].place : place;
        known_[theirs] = diagrams.choose(ours, without, with);
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

std::optional<std::pair<std::uint32_t, std::uint32_t>> Answers::repetition() {
    const std::uint32_t kind = next();
    if (kind == kEnd) return std::nullopt;
    if (kind != kRepeats) end();
    const std::uint32_t before = word();
    return std::pair(before, word());
}

}  // namespace etlc::prove
