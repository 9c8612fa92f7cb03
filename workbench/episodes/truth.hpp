// Evaluates truths: formulas over the present and past of recorded inputs, frame by frame, as
// docs/language.md defines them, read as Boolean. A missing sample may leave a truth unknown.
// Numbers are computed in double with exact comparisons and literals as written; `hold`,
// `stale after` and ranges apply as in the monitor. Operators are those of the monitor, in a plan
// of truth values. The work of a step does not depend on the length of a window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "compile.hpp"
#include "episodes/labels/labels.hpp"
#include "execute/evaluator.hpp"

namespace etlc::episodes {

// ---- distances in double ------------------------------------------------------------------------
// Distances in double, for truths; monitors compute in float32. The target set and the weights are
// the monitor's float32 numbers, everything computed from them is double.

/// Returns d(point, target) aggregated over the target set; `point` has as many elements as the
/// target has columns. Returns nothing for the zero vector under cosine and angular, because it has
/// no direction.
std::optional<double> exact_distance(const check::Model& model, const check::Distance& distance,
                                     const std::vector<double>& point);

/// Returns d(point, other) likewise.
std::optional<double> exact_distance(const check::Distance& distance,
                                     const std::vector<double>& point,
                                     const std::vector<double>& other);

/// Aggregates the distances of the rows, of which there is at least one.
double aggregate(const check::Distance& distance, std::vector<double> rows);

// ---- numbers that earlier steps have a part in --------------------------------------------------
// Numbers that earlier steps have a part in, in double, for truths. The work of a step does not
// depend on the length of a window.

class PastValues {
public:
    explicit PastValues(const check::Past& past) : past_(&past) {}

    void reset();
    /// Takes the value of its expression at this frame, NaN where it is missing. Returns the
    /// number, NaN while a value that it is made of is missing.
    double push(double value);

private:
    void add(double value, double sign);
    double mean() const;
    double extreme(double value);

    const check::Past* past_;
    std::deque<double> values_;  ///< the last ones, none of which a window lacks
    std::size_t frame_ = 0;
    /// For a min or max: the values that may still be it, with their frames; the first is it now.
    std::deque<std::pair<std::size_t, double>> candidates_;
    std::vector<double> sum_;  ///< of a mean: its exact parts, small ones first, without infinities
    std::size_t above_ = 0;    ///< infinities in the window
    std::size_t below_ = 0;
};

// ---- truths -------------------------------------------------------------------------------------

using check::Index;

/// The samples of one frame by index of the model's inputs, as recorded; empty where missing. An
/// int8 embedding holds its integers.
using Frame = std::vector<std::vector<double>>;

class TruthEvaluator {
public:
    /// `formulas`: those to evaluate.
    TruthEvaluator(const check::Model& model, const std::vector<Index>& formulas);
    TruthEvaluator(TruthEvaluator&&) = delete;  // the evaluator refers to the plan

    void reset();
    void step(const Frame& frame);
    /// Returns the label after the last step.
    Label operator[](Index formula) const { return labels_[formula]; }
    /// Returns the inputs that the formulas read, ascending.
    const std::vector<Index>& inputs() const { return inputs_; }

private:
    void take_inputs(const Frame& frame);
    void take_atoms();
    Label compare(const check::Predicate& predicate) const;
    double expression(const check::Expr& e) const;
    double measure(const check::Distance& distance) const;
    std::vector<double> elements(Index point, std::size_t ago) const;
    void take_pasts();

    const check::Model& model_;
    std::vector<Index> formulas_;
    std::vector<Index> atoms_;  ///< the formulas of bool inputs and predicates below
    std::vector<Index> inputs_;
    /// A plan of the formulas over bool inputs, one for each formula of the model that is an atom.
    Compiled temporal_;
    std::unique_ptr<execute::Evaluator> evaluator_;
    std::vector<execute::Sample> samples_;  ///< of these
    std::vector<Label> labels_;             ///< per formula
    Frame values_;                          ///< per input, after `hold`
    std::uint32_t longest_delay_ = 0;
    std::deque<Frame> earlier_;  ///< values of the frames before, the last one first
    Frame held_;
    std::vector<std::uint32_t> ages_;
    std::vector<execute::Freshness> freshness_;  ///< per input
    std::vector<Index> read_pasts_;              ///< past numbers of the model that formulas read
    std::vector<PastValues> past_values_;        ///< of these
    std::vector<double> pasts_;                  ///< per past number: at this frame
    bool has_begun_ = false;
};

/// The ground-truth monitor: the same formulas, in which bool inputs with the labels replace the
/// labelled predicates, and truths replace the lets that have one. A predicate without labels
/// counts as its own truth, decided by its comparison in a plan of truth values
/// (check::Values::boolean); one of `calibrated(normal, ...)` always holds. Formulas, lets,
/// monitors and the original inputs keep their indices.
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
/// Returns the label that a decided verdict states.
Label label_of(const etlmon::Verdict& verdict);

}  // namespace etlc::episodes
