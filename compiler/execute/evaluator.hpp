// Executes a plan, for `etlc run`, calibration, evaluation and libetlc: the verdicts and telemetry
// of the generated class, by the same runtime code. All memory is allocated by the constructor, and
// the work of a step does not depend on the history.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "etlmon/distance/enclosed.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "execute/inputs.hpp"
#include "execute/state.hpp"
#include "execute/tables.hpp"
#include "plan/program/program.hpp"

namespace etlc::execute {

/// A sample of one input as the caller has it; null where missing.
struct SampleView {
    const float* elements = nullptr;
    bool is_stale = false;  ///< missing, because it came too often in a row
};

class Evaluator {
public:
    /// Steps a state of its own.
    explicit Evaluator(const plan::Plan& plan);
    /// Shares the tables of another evaluator of the plan.
    Evaluator(const plan::Plan& plan, std::shared_ptr<const Tables> tables);

    const std::shared_ptr<const Tables>& tables() const { return tables_; }
    State& state() { return *state_; }
    const State& state() const { return *state_; }
    /// Returns a state before its first step.
    State new_state() const { return State(plan_, tables_->shape); }
    /// Steps another state of the plan from now on, which outlives its use. Until the next step,
    /// what the predicates of the last one were computed from is unknown.
    void use(State& state);

    void reset();
    /// Executes a step; `samples`: by index of the model's inputs (only those that a monitor
    /// depends on are read). The verdicts are by index of plan.monitors and valid until the next
    /// call.
    const std::vector<etlmon::Verdict>& step(const std::vector<Sample>& samples);
    /// The same for samples in the memory of the caller, which stay there until the next step: an
    /// input without `hold` is not copied.
    const std::vector<etlmon::Verdict>& step_on(const SampleView* samples) {
        return step(samples, true);
    }
    /// Ends the trace: per call, sliding monitors report one of their last positions, prefix
    /// monitors their last verdict.
    const std::vector<etlmon::Verdict>& finish();

    /// Returns the verdict of each let at the last step.
    const std::vector<etlmon::Verdict>& lets() const { return state_->lets; }

    /// Restarts a monitor of the plan with the next step.
    void restart(std::size_t monitor);
    /// Returns the position of the last verdict, where it is decided.
    std::uint64_t position(std::size_t monitor) const;

    /// Returns delta of the last step, by index of the model's predicates; NaN where unknown.
    float distance(check::Index predicate) const { return state_->measured[predicate].delta; }
    /// Returns the row of the nearest target; plain distances only.
    std::uint32_t nearest(check::Index predicate) const {
        return state_->measured[predicate].nearest;
    }
    /// Returns the row of the nearest target of any predicate, for each of its distances.
    std::uint32_t nearest(check::Index predicate, check::Index distance) const;
    std::uint32_t missing_steps() const { return state_->missing_steps; }
    /// Returns counts by index of the model's inputs; only those that a monitor depends on are
    /// counted.
    const std::vector<SampleCounts>& sample_counts() const { return state_->counts; }

    /// Returns the threshold of the next step. An adaptive one moves with the labels given to
    /// observe() and, as in generated code, survives reset(); only the caller gives labels, so
    /// `etlc run` uses the calibrated one.
    float threshold(check::Index predicate) const { return state_->thresholds[predicate]; }
    void observe(check::Index predicate, float distance, bool truth);

    /// Ends the episode regularly: its scores count for the drifts, by index of plan.drifts.
    void end_episode();
    const etlmon::DriftCells& drift_cells(std::size_t drift) const {
        return model_.drifts[plan_.drifts[drift]].cells;
    }
    const etlmon::Drift& drift(std::size_t drift) const { return state_->drifts[drift]; }

    /// Return what the predicates of the last step were computed from, by index in the model: an
    /// input's values after `hold`, null where missing, and a distance with its nearest row.
    const float* input(check::Index input) const { return inputs_[input]; }
    etlmon::Measured measured(check::Index distance) const { return distances_[distance]; }
    /// Returns the value of the expression of a number that earlier steps have a part in; NaN where
    /// it is missing.
    float operand_of(check::Index past) const { return past_operands_[past]; }
    /// Returns the elements of a point of the model that is measured; null where unknown.
    const float* point(check::Index point) const { return point_at_[point]; }
    /// Returns the elements that it had `ago` steps before, where a point of the model needs them;
    /// after a step as well as within it.
    const float* point(check::Index point, std::uint32_t ago) const;
    /// Returns the rows that may be nearest to z, for a distance by full weights to its nearest row
    /// (near_rows.hpp).
    const std::vector<std::uint32_t>& near_rows(check::Index distance, const float* z,
                                                double margin) const {
        return near_.at(distance).of(z, margin);
    }

    /// Replaces the robustness of measured predicates in formulas: calibration accounts for the
    /// measurements of other builds. The ends go through formulas independently; negation exchanges
    /// them.
    using PredicateValue = std::function<etlmon::Value(check::Index predicate)>;
    void replace_predicate_values(PredicateValue value) { replacement_ = std::move(value); }
    /// Calls `taken` at every step before predicates are measured, when inputs, distances and past
    /// numbers are known.
    void after_pasts(std::function<void()> taken) { after_pasts_ = std::move(taken); }

private:
    void make_room();
    void restart_those_due();
    const std::vector<etlmon::Verdict>& step(const SampleView* samples, bool borrow);
    void take_inputs(const SampleView* samples, bool borrow);
    const float* keep(check::Index input, const float* elements, bool borrow);
    void measure_points();
    const float* take_point(check::Index point);
    const float* join(const check::Point& point, float* elements) const;
    const float* sum(const check::Point& point, float* elements) const;
    const EarlierSamples& earlier_of(check::Index point) const;
    void keep_points();
    void measure_distances();
    void take_pasts();
    void measure_predicates();
    /// Returns whether all distances of a predicate are known.
    bool is_measured(const check::Predicate& predicate) const;
    etlmon::Enclosed measure(check::Index distance, const float* z);
    etlmon::Measured measure_wide(check::Index distance, const float* z);
    etlmon::Enclosed measure_contrast(const check::Predicate& predicate);
    etlmon::Measured measure_near(check::Index distance, const float* z);
    float expression(const check::Expr& e) const;
    void advance_streams();
    etlmon::Value advance(const plan::Stream& stream, State::OfStream& state) const;
    etlmon::Value advance_count(const plan::Stream& stream, State::OfStream& state) const;
    etlmon::Value advance_window(const plan::Stream& stream, State::OfStream& state) const;
    etlmon::Value operand(const plan::Stream& stream, std::size_t i,
                          etlmon::Value where_none) const;
    bool exists(std::uint32_t lag) const { return state_->steps >= lag && state_->finished <= lag; }
    /// Returns the steps since the trace or this monitor began.
    std::uint64_t steps_since(std::uint32_t begins_with) const {
        return begins_with == check::kNone ? state_->steps
                                           : state_->steps - state_->starts[begins_with];
    }
    void advance_readings();
    etlmon::Reading advance(const plan::Reading& reading, State::OfReading& state) const;
    etlmon::Reading run(const plan::Straight& code, State::OfReading& state,
                        std::uint64_t position) const;
    etlmon::Reading run(const plan::Table& table, State::OfReading& state) const;
    etlmon::Value value(const plan::Term& term, const State::OfReading& state,
                        std::uint64_t position) const;
    void judge();
    void see_scores();

    const plan::Plan& plan_;
    const check::Model& model_;
    std::shared_ptr<const Tables> tables_;
    std::unique_ptr<State> own_;
    State* state_;  ///< own_ or another

    // What a step computes, and nothing reads at the next one.
    std::vector<SampleView> views_;           ///< per input of the model
    std::vector<const float*> inputs_;        ///< per input: this step's values; null: missing
    std::vector<std::vector<float>> taken_;   ///< per input without `hold`: its values
    std::vector<std::vector<float>> points_;  ///< per point: memory of vectors and projections
    std::vector<const float*> point_at_;      ///< per point: its elements; null: unknown
    std::vector<float> centred_;              ///< of a projection
    bool points_are_kept_ = false;            ///< those of this step are among the earlier ones
    /// For distances by full weights to the nearest row: candidate rows, and room for their values.
    mutable std::map<check::Index, NearRows> near_;
    std::vector<float> near_values_;
    std::vector<etlmon::Measured> distances_;
    std::vector<etlmon::Enclosed> enclosed_;  ///< per distance: with bounds for narrow targets
    std::vector<float> pasts_;                ///< per past number of the model
    std::vector<float> past_operands_;        ///< likewise: its expression
    std::vector<float> scratch_;
    std::vector<etlmon::Value> streams_;
    std::vector<etlmon::Reading> readings_;
    PredicateValue replacement_;
    std::function<void()> after_pasts_;
};

}  // namespace etlc::execute
