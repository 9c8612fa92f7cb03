// The samples that support a verdict, which of them it needs, and the smallest change that would
// flip it.
#pragma once

#include <optional>
#include <vector>

#include "explain/claim.hpp"
#include "explain/values.hpp"

namespace etlc::explain {

class Support {
public:
    /// Considers the samples whose value is at least as far on the side of the status as `least`.
    Support(const Subject& subject, const Judged& judged, etlmon::Key least);

    /// Returns the samples by step, then atom.
    const std::vector<Sample>& samples() const { return samples_; }
    /// Returns the literals of a sample that support the status.
    std::vector<NodeId> literals(Sample sample) const;
    /// Returns whether the status needs one of these literals beside the evidence that is left.
    bool needs(const std::vector<Evidence>& literals) { return claim_.needs(literals); }
    /// Withdraws the sample unless the status needs it; returns whether it did.
    bool can_do_without(Sample sample) { return claim_.can_do_without(evidence(sample)); }

private:
    std::vector<Evidence> evidence(Sample sample) const;

    std::vector<std::vector<NodeId>> literals_;  ///< per atom, those that depend on its samples
    Claim claim_;
    std::vector<Sample> samples_;
};

/// Returns the smallest change of one measurement behind the samples that flips the verdict; a bool
/// only where no other measurement does. Alters the values meanwhile and restores them.
std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples);

}  // namespace etlc::explain
