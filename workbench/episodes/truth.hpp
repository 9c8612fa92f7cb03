// Evaluates truths: formulas over the present and past of recorded inputs, frame by frame, as
// docs/language.md defines them, read as Boolean. A missing sample may leave a truth unknown.
// Everything is computed in double with exact comparisons and literals as written; `hold`,
// `stale after` and ranges apply as in the monitor. The work of a step does not depend on the
// length of a window.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/labels/label.hpp"
#include "episodes/past_values.hpp"
#include "execute/inputs.hpp"

namespace etlc::episodes {

using check::Index;

/// The samples of one frame by index of the model's inputs, as recorded; empty where missing. An
/// int8 embedding holds its integers.
using Frame = std::vector<std::vector<double>>;

class TruthEvaluator {
public:
    /// `formulas`: those to evaluate.
    TruthEvaluator(const check::Model& model, const std::vector<Index>& formulas);

    void reset();
    void step(const Frame& frame);
    /// Returns the label after the last step.
    Label operator[](Index formula) const { return labels_[formula]; }
    /// Returns the inputs that the formulas read, ascending.
    const std::vector<Index>& inputs() const { return inputs_; }

private:
    /// The memory of `f S[a,b] g`, and of O, H and Y, which it defines: the last frames that
    /// decide. Frames count from 1.
    struct Memory {
        std::deque<Label> delayed;        ///< g in the last a frames
        std::uint64_t last_yes = 0;       ///< last frame, at least a ago, at which g was yes
        std::uint64_t last_possible = 0;  ///< the same for yes or unknown
        std::uint64_t f_not_yes = 0;      ///< last frame at which f was no or unknown
        std::uint64_t f_no = 0;
        // Of a count:
        Label before = Label::yes;  ///< f at the last frame; before the first nothing begins
        std::deque<Label> begins;   ///< where f began to hold, in the last frames
        std::int64_t yes = 0;       ///< how many of these are yes,
        std::int64_t possible = 0;  ///< and yes or unknown
    };

    void take_inputs(const Frame& frame);
    Label value(Index index);
    Label compare(const check::Predicate& predicate) const;
    double expression(const check::Expr& e) const;
    double measure(const check::Distance& distance) const;
    std::vector<double> elements(Index point, std::size_t ago) const;
    void take_pasts();
    static Label count_of(const check::Formula& formula, Memory& memory, Label f);
    Label in_the_past(const check::Formula& formula, Memory& memory, Label f, Label g) const;

    const check::Model& model_;
    std::vector<Index> order_;  ///< formulas to evaluate, operands first
    std::vector<Index> inputs_;
    std::vector<Label> labels_;
    std::vector<Memory> memories_;  ///< per formula
    Frame values_;                  ///< per input, after `hold`
    std::uint32_t longest_delay_ = 0;
    std::deque<Frame> earlier_;  ///< values of the frames before, the last one first
    Frame held_;
    std::vector<std::uint32_t> ages_;
    std::vector<execute::Freshness> freshness_;  ///< per input
    std::vector<Index> read_pasts_;              ///< past numbers of the model that formulas read
    std::vector<PastValues> past_values_;        ///< of these
    std::vector<double> pasts_;                  ///< per past number: at this frame
    std::uint64_t frame_ = 0;                    ///< from 1; 0 before the first
};

/// The ground-truth monitor: the same formulas, in which bool inputs with the labels replace the
/// labelled predicates, and truths replace the lets that have one. A predicate without labels
/// counts as its own truth, decided by its comparison in a plan of truth values
/// (check::Values::boolean). Formulas, lets, monitors and the original inputs keep their indices.
struct GroundTruth {
    check::Model model;
    /// Per predicate of the original model, the input of its label; kNone without labels.
    std::vector<Index> inputs;
};

GroundTruth ground_truth(const check::Model& model, const std::vector<Index>& labelled);

/// Returns the labelled predicates, ascending.
std::vector<Index> labelled_predicates(const GroundTruth& truth);

/// Returns the label as a sample of such an input; unknown becomes missing.
execute::Sample sample_of(Label label);

}  // namespace etlc::episodes
