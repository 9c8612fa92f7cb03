// What of a spec can be evaluated on these data, and against what.
// Takes: the model and which predicates have labels. Gives: the ground-truth model, in which every
// predicate is replaced by its truth, and what keeps the other monitors from being evaluated. Keeps
// true: a predicate over scalars with a literal threshold and without a truth is its own; another
// without a truth is not, and its monitors are left out.
#pragma once

#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/truth.hpp"

namespace etlc::evaluate {

using check::Index;

struct MonitorSubject {
    Index monitor = 0;           ///< of the model
    std::vector<Index> lacking;  ///< predicates that have no truth; empty: it can be evaluated
    Index truth = check::kNone;  ///< of the ground-truth model's monitors
    /// F (a && F (b && ...)): for each of a, b, ... the monitor F a, F b, ... of the ground-truth
    /// model; else empty.
    std::vector<Index> stages;
};

struct Subject {
    std::vector<Index> labelled;  ///< predicates
    episodes::GroundTruth truth;
    std::vector<MonitorSubject> monitors;
};

/// `labelled`: predicates that the spec or every episode has a truth of.
Subject subject(const check::Model& model, std::vector<Index> labelled);

/// Whether there is anything to compare with: a label, or a monitor that is its own truth.
bool has_truths(const Subject& subject);

}  // namespace etlc::evaluate
