// The samples that speak for a status, and which of them it needs.
#pragma once

#include <vector>

#include "explain/claim.hpp"
#include "explain/subject.hpp"

namespace etlc::explain {

class Support {
public:
    /// Of the samples that support the judged status: those whose value is at least as far on its
    /// side as `least`.
    Support(const Subject& subject, const Judged& judged, etlmon::Key least);

    /// By step, then atom.
    const std::vector<Sample>& samples() const { return samples_; }
    /// The literals of a sample that speak for the status.
    std::vector<NodeId> literals(Sample sample) const;
    /// Whether the status needs one of these literals, beside what else is still there.
    bool needs(const std::vector<Evidence>& literals) { return claim_.needs(literals); }
    /// Takes the sample away unless it does.
    bool can_do_without(Sample sample) { return claim_.can_do_without(evidence(sample)); }

private:
    std::vector<Evidence> evidence(Sample sample) const;

    std::vector<std::vector<NodeId>> literals_;  ///< per atom, those that it has to speak for
    Claim claim_;
    std::vector<Sample> samples_;
};

}  // namespace etlc::explain
