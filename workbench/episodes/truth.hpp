// Ground truth: formulas over recorded inputs, present and past, one frame after the other.
// Takes: formulas of the model without future operators, and the numbers of one frame a step, as
// recorded. Gives: yes, no, or unknown where a missing sample leaves it open. Keeps true: computed
// in double with exact comparisons, literals as written; a `hold` and a range apply as they do to
// the monitor; the definitions are those of docs/language.md, read as Boolean; the work of a step
// does not depend on the length of a window.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "check/model/model.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

using check::Index;

/// Ordered: && is the least, || the greatest, unknown in between (Kleene's strong logic).
enum class Label : std::uint8_t { no, unknown, yes };

/// The samples of one frame by index of the model's inputs; empty: missing. An int8 embedding holds
/// its integers.
using Frame = std::vector<std::vector<double>>;

class TruthEvaluator {
public:
    /// `formulas`: those whose value is asked for.
    TruthEvaluator(const check::Model& model, const std::vector<Index>& formulas);

    void reset();
    void step(const Frame& frame);
    /// After the last step.
    Label operator[](Index formula) const { return labels_[formula]; }
    /// The inputs that the formulas read, ascending.
    const std::vector<Index>& inputs() const { return inputs_; }

private:
    /// Of `f S[a,b] g`, and of O, H and Y, which it defines: the last frames that decide. A frame
    /// is counted from 1.
    struct Memory {
        std::deque<Label> delayed;        ///< g of the last a frames
        std::uint64_t last_yes = 0;       ///< frame, at least a ago, at which g was yes
        std::uint64_t last_possible = 0;  ///< yes or unknown
        std::uint64_t f_not_yes = 0;      ///< frame at which f was no or unknown
        std::uint64_t f_no = 0;
    };

    void take_inputs(const Frame& frame);
    Label value(Index index);
    Label compare(const check::Predicate& predicate) const;
    double expression(const check::Expr& e) const;
    double measure(const check::Distance& distance) const;
    Label in_the_past(const check::Formula& formula, Memory& memory, Label f, Label g) const;

    const check::Model& model_;
    std::vector<Index> order_;  ///< formulas to evaluate, operands first
    std::vector<Index> inputs_;
    std::vector<Label> labels_;
    std::vector<Memory> memories_;  ///< per formula
    Frame values_;                  ///< per input, after `hold`
    Frame held_;
    std::vector<std::uint32_t> ages_;
    std::uint64_t frame_ = 0;  ///< from 1; 0 before the first
};

/// The ground-truth monitor: the same formulas, whose predicates with labels are bool inputs that
/// hold these. A predicate without labels is its own truth, which its comparison decides where the
/// plan is one of truth values (check::Values::boolean). Formulas, monitors and the inputs that
/// were there keep their indices.
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
