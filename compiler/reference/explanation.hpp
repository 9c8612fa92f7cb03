// Finds the critical sample and the explanation of a verdict by brute force, as
// docs/explanations.md defines them: by evaluating the formula again with other values of its
// literals.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "reference/prefix.hpp"
#include "reference/reference.hpp"

namespace etlc::reference {

/// A predicate or a bool at a step; the order is that of steps, then of the spec.
struct Sample {
    std::uint64_t step = 0;
    std::uint32_t place = 0;  ///< place in the text of the spec
    bool is_predicate = true;
    Index index = 0;  ///< index of the model's predicates, or of its inputs

    auto operator<=>(const Sample&) const = default;
};
using SampleSet = std::set<Sample>;

/// Another measurement: a delta, or the 0 or 1 of a bool.
struct Alteration {
    bool is_predicate = true;
    Index index = 0;
    std::uint64_t step = 0;
    double measured = 0;
};

/// Returns the literals of a form on the whole trace, with some samples altered.
Literals literals(const check::Model& model, const NormalForm& form, const Trace& trace,
                  check::Values values, const std::vector<Alteration>& alterations = {});

/// The status of a verdict, and whether it is final.
struct Outcome {
    Status status = Status::unknown;
    bool for_good = false;

    bool operator==(const Outcome&) const = default;
};

/// One monitor's rho(f, position, step) with its bounds.
class Explained {
public:
    /// `form`: the monitors' formulas, as written or simplified.
    Explained(const check::Model& model, NormalForm form, const Trace& trace, check::Values values,
              Index monitor, std::uint64_t position, std::uint64_t step);

    /// Returns the status on the prefix, with all samples.
    Outcome outcome() const { return outcome_; }
    Outcome outcome_with_only(const SampleSet& known) const;
    Outcome outcome_with(const std::vector<Alteration>& alterations) const;

    /// Returns the sample of the deciding value, which is the bound of a final verdict, else rho;
    /// nothing where that is the value of an empty window, a constant, or an unseen step.
    std::optional<Sample> critical() const;
    /// Applies the rule: from the samples that support the verdict as far as the deciding value,
    /// drops the last ones first, and the critical one at the very end, where the rest still gives
    /// the verdict.
    SampleSet explanation() const;

private:
    Value value(const Literals& literals) const;
    Outcome outcome_of(const Value& value) const;
    double deciding(const Value& value) const;
    Sample sample(const Node& literal, std::uint64_t step) const;

    const check::Model& model_;
    const Trace& trace_;
    check::Values values_;
    NormalForm form_;
    Literals literals_;
    Index root_;
    std::uint64_t position_;
    std::uint64_t step_;
    std::pair<double, double> shifts_;
    Outcome outcome_;
};

}  // namespace etlc::reference
