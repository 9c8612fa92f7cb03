// Adaptive thresholds in tests: random specs that have some, labels for them, and the expected
// effect of the labels. Takes: seeds. Gives: specs with their thresholds files, labels, and the
// thresholds at every step by the update in docs/language.md, in double. Keeps true: alpha, gamma
// and all ends are dyadic, so double is exact; the update shares no code with the runtime's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "random_spec.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// observe_P(distance, truth)
struct Label {
    float distance = 0;
    bool truth = false;
};
/// labels[step][predicate]: passed before the step, in this order.
using Labels = std::vector<std::vector<std::vector<Label>>>;

struct AdaptiveSpec {
    std::string text;
    std::string thresholds;  ///< the thresholds file
    std::optional<check::Model> model;
};

/// Makes some literal thresholds of random_spec adaptive, starting at the literal.
AdaptiveSpec random_adaptive_spec(std::uint64_t seed, const SpecShape& shape);

/// Makes labels with distances of earlier steps, numbers on the grid, infinities and NaN; most
/// labels are positive.
Labels random_labels(const check::Model& model, const reference::Trace& trace, std::uint64_t seed);

/// Returns the thresholds of a monitor without labels.
std::vector<double> calibrated_thresholds(const check::Model& model);

/// Moves `now` by the labels of a whole trace; returns the thresholds at each of its steps.
reference::Thresholds tracked(const check::Model& model, const Labels& labels,
                              std::vector<double>& now);

}  // namespace etlc::tests
