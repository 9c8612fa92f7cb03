// The ground-truth monitor: the same formulas with predicates replaced by what they are meant to
// mean. Takes: the model and which predicates have labels. Gives: a model whose monitors read,
// instead of each of these, a bool input that holds its label. Keeps true: everything else is as it
// was, so a predicate without labels is its own truth, which its comparison decides where the plan
// is one of truth values (check::Values::boolean); formulas, monitors and the inputs that were
// there keep their indices.
#pragma once

#include <vector>

#include "check/model/model.hpp"
#include "episodes/truth.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

struct GroundTruth {
    check::Model model;
    /// Per predicate of the original: the input of its label; kNone where it has none.
    std::vector<Index> inputs;
};

GroundTruth ground_truth(const check::Model& model, const std::vector<Index>& labelled);

/// The predicates that have labels, ascending.
std::vector<Index> labelled_predicates(const GroundTruth& truth);

/// The label as the sample of such an input; unknown is missing.
plan::Sample sample_of(Label label);

}  // namespace etlc::episodes
