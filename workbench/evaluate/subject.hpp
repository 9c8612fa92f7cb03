// Selects the monitors of a spec that can be evaluated, and builds the ground-truth model, in which
// every predicate is replaced by its truth. A predicate over scalars with a literal threshold is
// its own truth; a monitor with any other predicate without labels is left out.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/truth.hpp"

namespace etlc::evaluate {

using check::Index;

struct MonitorSubject {
    Index monitor = 0;           ///< in the model
    std::vector<Index> lacking;  ///< predicates without a truth; empty: it can be evaluated
    Index truth = check::kNone;  ///< monitor in the ground-truth model
    /// For F (a && F (b && ...)) the monitors F a, F b, ... of the ground-truth model; else empty.
    std::vector<Index> stages;
};

struct Subject {
    std::vector<Index> labelled;  ///< predicates
    std::vector<Index> lets;      ///< with a truth over these; check::Options::judged_lets
    episodes::GroundTruth truth;
    std::vector<MonitorSubject> monitors;
};

/// `labelled` lists the predicates with a truth in the spec or in every episode.
Subject subject(const check::Model& model, std::vector<Index> labelled);

/// Returns whether there is a label or a monitor that is its own truth.
bool has_truths(const Subject& subject);

}  // namespace etlc::evaluate
