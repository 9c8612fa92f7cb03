// Steps a generated class over all short sequences of equal, different and missing samples, and
// compares which samples it used with a plain loop over the definition of `stale after` and `hold`.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "stale.hpp"

namespace {

/// The sample of an input at a step. +0 and -0 are different samples; an int8 has another number
/// in place of -0.
enum Symbol : std::uint8_t { nothing, unusable, one, other, zero, negative_zero, kSymbols };

constexpr float kNan = __builtin_nanf("");
constexpr float kFloats[kSymbols][3] = {{},        {0, kNan, 0}, {1, 0, 0},
                                        {1, 0, 1}, {0, 0, 0},    {0, 0, -0.0F}};
constexpr std::uint16_t kHalves[kSymbols][3] = {
    {}, {0, 0x7e00, 0}, {0x3c00, 0, 0}, {0x3c00, 0, 0x3c00}, {0, 0, 0}, {0, 0, 0x8000}};
constexpr std::int8_t kBytes[kSymbols][3] = {{}, {}, {1, 0, 0}, {1, 0, 1}, {0, 0, 0}, {0, 0, -1}};
constexpr float kScalars[kSymbols] = {kNan, 9, 1, 2, 0, -0.0F};
constexpr float kUnbounded[kSymbols] = {kNan, kNan, 1, 2, 0, -0.0F};

using Sequence = std::vector<Symbol>;

stale::Inputs inputs(Symbol symbol) {
    stale::Inputs in;
    if (symbol == nothing) return in;
    in.z = kFloats[symbol];
    in.half = kHalves[symbol];
    if (symbol != unusable) in.byte = kBytes[symbol];
    in.x = kScalars[symbol];
    in.y = kUnbounded[symbol];
    return in;
}

/// Returns whether a step has a sample to use: of equal samples in a row only `most` count,
/// whatever is missing between them, and the last that counts replaces `hold` missing ones.
std::vector<bool> used(const Sequence& sequence, std::size_t most, std::size_t hold) {
    std::vector<bool> result;
    Sequence seen;
    std::size_t age = hold;
    for (const Symbol symbol : sequence) {
        bool fresh = symbol != nothing && symbol != unusable;
        if (fresh) {
            seen.push_back(symbol);
            std::size_t equal = 0;
            while (equal < seen.size() && seen[seen.size() - 1 - equal] == symbol) ++equal;
            fresh = equal <= most;
        }
        result.push_back(fresh || age < hold);
        age = fresh ? 0 : age < hold ? age + 1 : age;
    }
    return result;
}

using Known = std::array<bool, 5>;

Known known(const stale::Verdicts& v) {
    const auto is_known = [](const auto& verdict) {
        return verdict.satisfied() || verdict.violated();
    };
    return {is_known(v.of_z), is_known(v.of_half), is_known(v.of_byte), is_known(v.of_x),
            is_known(v.of_y)};
}

void expect_uses(stale::Monitor& monitor, const Sequence& sequence) {
    const std::vector<bool> expected[] = {used(sequence, 2, 0), used(sequence, 3, 1),
                                          used(sequence, 1, 0), used(sequence, 2, 0),
                                          used(sequence, 1, 2)};
    monitor.reset();
    for (std::size_t step = 0; step < sequence.size(); ++step) {
        stale::Monitor copy = monitor;  // a copy goes on as the original does
        const Known found = known(monitor.step(inputs(sequence[step])));
        ASSERT_EQ(known(copy.step(inputs(sequence[step]))), found);
        for (std::size_t i = 0; i < found.size(); ++i)
            ASSERT_EQ(found[i], expected[i][step]) << "input " << i << ", step " << step;
    }
}

/// Returns the n-th sequence of this length.
Sequence sequence_of(std::size_t n, std::size_t length, std::size_t symbols) {
    Sequence result;
    for (std::size_t step = 0; step < length; ++step, n /= symbols)
        result.push_back(static_cast<Symbol>(n % symbols));
    return result;
}

void expect_all(std::size_t length, std::size_t symbols) {
    std::size_t count = 1;
    for (std::size_t step = 0; step < length; ++step) count *= symbols;
    stale::Monitor monitor;
    for (std::size_t n = 0; n < count; ++n) {
        expect_uses(monitor, sequence_of(n, length, symbols));
        if (testing::Test::HasFatalFailure()) return;
    }
}

TEST(Stale, AllSequencesOfAllSymbols) {
    expect_all(6, kSymbols);
}
TEST(Stale, LongerSequencesOfTwoSamples) {
    expect_all(9, other + 1);
}

TEST(Stale, StepsAreCountedAsMissing) {
    stale::Monitor monitor;
    for (int step = 0; step < 5; ++step) monitor.step(inputs(one));
    EXPECT_EQ(monitor.missing_steps(), 4U);  // byte may come once
    monitor.reset();
    monitor.step(inputs(one));
    EXPECT_EQ(monitor.missing_steps(), 0U);
}

}  // namespace
