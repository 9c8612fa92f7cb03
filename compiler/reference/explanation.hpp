// The critical sample and the explanation of a verdict by brute force, as docs/explanations.md
// defines them.
// Takes: the typed spec and a trace. Gives: the status with only some samples known; the sample
// whose value rho is; the set that the rule leaves. Keeps true: each is found by evaluating the
// formula again, with other values of its literals.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "check/model/model.hpp"
#include "reference/prefix.hpp"
#include "reference/reference.hpp"

namespace etlc::reference {

/// A predicate or a bool at a step; the order is that of steps, then of the spec.
struct Sample {
    std::uint64_t step = 0;
    std::uint32_t place = 0;  ///< in the text of the spec
    bool is_predicate = true;
    Index index = 0;  ///< of the model's predicates, or of its inputs

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

/// The literals of a form on the whole trace, with some samples altered.
Literals literals(const check::Model& model, const NormalForm& form, const Trace& trace,
                  check::Values values, const std::vector<Alteration>& alterations = {});

/// What a verdict says.
struct Said {
    Status status = Status::unknown;
    bool for_good = false;

    bool operator==(const Said&) const = default;
};

/// One monitor's rho(f, position, step) with its bounds.
class Explained {
public:
    /// `form`: the monitors' formulas, as they are written or simplified.
    Explained(const check::Model& model, NormalForm form, const Trace& trace, check::Values values,
              Index monitor, std::uint64_t position, std::uint64_t step);

    /// Of the prefix, with all that the trace has.
    Said said() const { return said_; }
    Said said_with_only(const SampleSet& known) const;
    Said said_with(const std::vector<Alteration>& alterations) const;

    /// Whose value the deciding one is: for good the bound, else rho; nothing where it is that of
    /// an empty window, a constant, or a step that is not yet seen.
    std::optional<Sample> critical() const;
    /// The rule: from those samples that support the verdict as far as the deciding value does, the
    /// last ones are left out first, and the critical one at the very end, wherever the rest gives
    /// the verdict.
    SampleSet explanation() const;

private:
    Value value(const Literals& literals) const;
    Said said_of(const Value& value) const;
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
    double shift_;
    Said said_;
};

}  // namespace etlc::reference
