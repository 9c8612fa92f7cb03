// Tests the diagrams of proofs against tables of all zeros and ones, and of all thresholds.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "prove/stand_in/etlprove/diagrams.hpp"
#include "random.hpp"

namespace {

using namespace etlprove;
using etlc::tests::Random;

constexpr std::uint32_t kSteps = 2, kAtoms = 2;

/// An expression over the ends of samples and numbers: its diagram, and its value for any samples.
struct Expression {
    Diagram diagram;
    std::function<double(const std::vector<double>&)> value;  ///< of low and high of each sample
};

class RandomExpression {
public:
    RandomExpression(Random& random, Diagrams& diagrams, Numbers& numbers)
        : random_(random), diagrams_(diagrams), numbers_(numbers) {}

    Expression make(int depth) {
        if (depth == 0) return leaf();
        const Expression a = make(depth - 1), b = make(depth - 1);
        if (random_.chance(0.2))
            return {diagrams_.negation(a.diagram),
                    [a](const auto& ends) { return -a.value(ends); }};
        if (random_.chance(0.5))
            return {diagrams_.both(a.diagram, b.diagram),
                    [a, b](const auto& ends) { return std::min(a.value(ends), b.value(ends)); }};
        return {diagrams_.either(a.diagram, b.diagram),
                [a, b](const auto& ends) { return std::max(a.value(ends), b.value(ends)); }};
    }

private:
    Expression leaf() {
        if (random_.chance(0.2)) {
            const float number = static_cast<float>(random_.between(-1, 1));
            return {numbers_.at_least(number), [number](const auto&) { return number; }};
        }
        const std::uint32_t step = random_.between(0, kSteps - 1);
        const std::uint32_t atom = random_.between(0, kAtoms - 1);
        const bool high = random_.chance(0.5), negated = random_.chance(0.5);
        const std::size_t at = (step * kAtoms + atom) * 2 + (high ? 1 : 0);
        const Place end = (high ? kHigh : kLow) + (negated ? 1 : 0);
        return {diagrams_.variable(place_of({step, kSteps}, atom, kAtoms, end)),
                [at, negated](const auto& ends) { return negated ? -ends[at] : ends[at]; }};
    }

    Random& random_;
    Diagrams& diagrams_;
    Numbers& numbers_;
};

/// Returns whether a diagram is true for these ends of samples and this threshold.
bool is_true(const Diagrams& diagrams, const Numbers& numbers, Diagram of,
             const std::vector<double>& ends, double threshold) {
    while (of > kAlways) {
        const Diagrams::Node node = diagrams[of];
        bool holds = false;
        if (node.place < kFirstSample) {
            holds = numbers[node.place] >= threshold;
        } else {
            const Place at = node.place - kFirstSample;
            const std::uint32_t step = kSteps - 1 - at / (kAtoms * kPlacesPerSample);
            const std::uint32_t atom = at / kPlacesPerSample % kAtoms;
            const Place end = at % kPlacesPerSample;
            const double value = ends[(step * kAtoms + atom) * 2 + end / 2];
            holds = (end % 2 == 0 ? value : -value) >= threshold;
        }
        of = holds ? node.with : node.without;
    }
    return of == kAlways;
}

TEST(Diagrams, AreTheValuesOfMinMaxAndNegationAtEveryThreshold) {
    Random random(1);
    for (int n = 0; n < 300; ++n) {
        Diagrams diagrams(1U << 20U, [] { FAIL(); });
        Numbers numbers(diagrams, {-1, 0, 1});
        const Expression expression = RandomExpression(random, diagrams, numbers).make(4);
        for (int sample = 0; sample < 100; ++sample) {
            std::vector<double> ends;
            for (std::uint32_t i = 0; i < 2 * kSteps * kAtoms; ++i)
                ends.push_back(random.between(-4, 4) / 2.0);
            for (int threshold = -5; threshold <= 5; ++threshold)
                ASSERT_EQ(is_true(diagrams, numbers, expression.diagram, ends, threshold / 2.0),
                          expression.value(ends) >= threshold / 2.0)
                    << n;
        }
    }
}

TEST(Diagrams, AreEqualForEqualFunctions) {
    Random random(2);
    int equal = 0;
    for (int n = 0; n < 300; ++n) {
        Diagrams diagrams(1U << 20U, [] { FAIL(); });
        Numbers numbers(diagrams, {-1, 0, 1});
        const Diagram a = RandomExpression(random, diagrams, numbers).make(2).diagram;
        const Diagram b = RandomExpression(random, diagrams, numbers).make(2).diagram;
        const Diagram c = RandomExpression(random, diagrams, numbers).make(1).diagram;
        const auto both = [&](Diagram x, Diagram y) { return diagrams.both(x, y); };
        const auto either = [&](Diagram x, Diagram y) { return diagrams.either(x, y); };
        ASSERT_EQ(both(a, either(b, c)), either(both(a, b), both(a, c)));
        ASSERT_EQ(either(a, both(a, b)), a);
        ASSERT_EQ(diagrams.negation(diagrams.negation(a)), a);
        ASSERT_EQ(diagrams.negation(both(a, b)),
                  either(diagrams.negation(a), diagrams.negation(b)));
        ASSERT_EQ(diagrams.differ(a, b) == kNever, a == b);
        equal += a == b ? 1 : 0;
    }
    EXPECT_GT(equal, 0);
}

}  // namespace
