// Executes a plan, for `etlc run`, calibration and evaluation: the verdicts and telemetry of the
// generated class, by the same runtime code. All memory is allocated by the constructor, and the
// work of a step does not depend on the history.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "etlmon/distance/enclosed.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/pending.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "plan/evaluate/earlier_samples.hpp"
#include "plan/evaluate/inputs.hpp"
#include "plan/evaluate/near_rows.hpp"
#include "plan/evaluate/past_state.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Executes a pending reading: evaluates the last positions of the prefix again at every step, in
/// constant memory, with the runtime loops of generated code.
class PendingEvaluator {
public:
    explicit PendingEvaluator(const Pending& pending);

    void reset();
    /// `position`: of the step, from the start; `streams`: all values at it.
    etlmon::Reading advance(std::uint64_t position, const std::vector<Value>& streams);

private:
    using Readings = std::vector<etlmon::Reading>;

    void evaluate_parts(std::uint32_t count, const std::vector<Value>& streams);
    void evaluate_part(std::size_t index, std::uint32_t count, const std::vector<Value>& streams);
    etlmon::Reading advance_fold(std::uint32_t step, std::uint32_t count,
                                 const std::vector<Value>& streams);
    etlmon::Reading advance_machine(std::uint32_t step, std::uint32_t count,
                                    const std::vector<Value>& streams);

    const Pending& pending_;
    /// Per part: the last horizon + 1 values, oldest first.
    std::vector<std::vector<Value>> leaves_;
    std::vector<Readings> parts_;   ///< per part: at the same positions
    std::vector<Value> registers_;  ///< of settled positions
    // scratch of a machine: guards by position, keys of its lists, registers
    Readings guards_;
    std::vector<Key> weak_;
    std::vector<Key> strong_;
    Readings scratch_;
    std::vector<Value> values_;
};

/// Counts of the samples of one input since reset().
struct SampleCounts {
    std::uint64_t missing = 0;       ///< absent, or not finite
    std::uint64_t out_of_range = 0;  ///< a scalar out of its declared range: counts as missing
    std::uint64_t stale = 0;         ///< repeated too often: counts as missing
    std::uint64_t held = 0;          ///< of all these, those replaced by `hold`
};

class Evaluator {
public:
    explicit Evaluator(const Plan& plan);

    void reset();
    /// Executes a step; `samples`: by index of the model's inputs (only those that a monitor
    /// depends on are read). The verdicts are by index of plan.monitors and valid until the next
    /// call.
    const std::vector<etlmon::Verdict>& step(const std::vector<Sample>& samples);
    /// Ends the trace: per call, sliding monitors report one of their last positions, prefix
    /// monitors their last verdict.
    const std::vector<etlmon::Verdict>& finish();

    /// Returns the verdict of each let at the last step.
    const std::vector<etlmon::Verdict>& lets() const { return lets_; }

    /// Restarts a monitor of the plan with the next step.
    void restart(std::size_t monitor);
    /// Returns the position of the last verdict, where it is decided.
    std::uint64_t position(std::size_t monitor) const;

    /// Returns delta of the last step, by index of the model's predicates; NaN where unknown.
    float distance(Index predicate) const { return measured_[predicate].delta; }
    /// Returns the row of the nearest target; plain distances only.
    std::uint32_t nearest(Index predicate) const { return measured_[predicate].nearest; }
    /// Returns the row of the nearest target of any predicate, for each of its distances.
    std::uint32_t nearest(Index predicate, Index distance) const;
    std::uint32_t missing_steps() const { return missing_steps_; }
    /// Returns counts by index of the model's inputs; only those that a monitor depends on are
    /// counted.
    const std::vector<SampleCounts>& sample_counts() const { return counts_; }

    /// Returns the threshold of the next step. An adaptive one moves with the labels given to
    /// observe() and, as in generated code, survives reset(); only the caller gives labels, so
    /// `etlc run` uses the calibrated one.
    float threshold(Index predicate) const { return thresholds_[predicate]; }
    void observe(Index predicate, float distance, bool truth);

    /// Return what the predicates of the last step were computed from, by index in the model: an
    /// input's values after `hold`, null where missing, and a distance with its nearest row.
    const float* input(Index input) const { return inputs_[input]; }
    etlmon::Measured measured(Index distance) const { return distances_[distance]; }
    /// Returns the value of the expression of a number that earlier steps have a part in; NaN where
    /// it is missing.
    float operand_of(Index past) const { return past_operands_[past]; }
    /// Returns the elements of a point of the model that is measured; null where unknown.
    const float* point(Index point) const { return point_at_[point]; }
    /// Returns the elements that it had `ago` steps before, where a point of the model needs them;
    /// after a step as well as within it.
    const float* point(Index point, std::uint32_t ago) const;
    /// Returns the rows that may be nearest to z, for a distance by full weights to its nearest row
    /// (near_rows.hpp).
    const std::vector<std::uint32_t>& near_rows(Index distance, const float* z,
                                                double margin) const {
        return near_.at(distance).of(z, margin);
    }

    /// Replaces the robustness of measured predicates in formulas: calibration accounts for the
    /// measurements of other builds. The ends go through formulas independently; negation exchanges
    /// them.
    using PredicateValue = std::function<Value(Index predicate)>;
    void replace_predicate_values(PredicateValue value) { replacement_ = std::move(value); }
    /// Calls `taken` at every step before predicates are measured, when inputs, distances and past
    /// numbers are known.
    void after_pasts(std::function<void()> taken) { after_pasts_ = std::move(taken); }

private:
    struct Held {
        std::vector<float> values;  ///< empty: none yet
        std::uint32_t age = 0;
    };
    struct StreamState {
        std::vector<Member> members;  ///< members with their first values
        std::vector<Value> values;
        std::vector<Key> lows;  ///< of the last values of a count, sorted
        std::vector<Key> highs;
        std::vector<etlmon::Since<Value>::Element> pairs;
        std::vector<etlmon::Handover<Value>::Element> flanks;
        std::uint32_t cursor = 0;
    };
    struct ReadingState {
        std::vector<Value> registers;  ///< of straight-line code, or one per state of a table
        std::vector<Value> next;       ///< locals, or the next registers of a table
        std::vector<Value> guards;
        std::vector<Key> weak;  ///< this step's keys in the table's lists
        std::vector<Key> strong;
        std::vector<Value> first;  ///< first registers of straight-line code
        std::optional<PendingEvaluator> pending;
    };

    void prepare_distances();
    static void reset_member(const Member& member, StreamState& state);
    void restart_those_due();
    static void reset_stream(StreamState& state);
    static void prepare_reading(const Reading& reading, ReadingState& state);
    static void reset_reading(const Reading& reading, ReadingState& state);
    void take_inputs(const std::vector<Sample>& samples);
    void measure_points();
    const float* take_point(Index point);
    const float* join(const check::Point& point, float* elements) const;
    const EarlierSamples& earlier_of(Index point) const;
    void keep_points();
    void keep_for(Index point, std::uint32_t ago, std::map<Index, std::uint32_t>& longest) const;
    void measure_distances();
    void take_pasts();
    void measure_predicates();
    /// Returns whether all distances of a predicate are known.
    bool is_measured(const check::Predicate& predicate) const;
    etlmon::Enclosed measure(Index distance, const float* z);
    etlmon::Measured measure_wide(Index distance, const float* z);
    etlmon::Enclosed measure_contrast(const check::Predicate& predicate);
    etlmon::Measured measure_near(Index distance, const float* z);
    float expression(const check::Expr& e) const;
    void advance_streams();
    Value advance(const Stream& stream, StreamState& state) const;
    Value advance_count(const Stream& stream, StreamState& state) const;
    Value advance_window(const Stream& stream, StreamState& state) const;
    Value operand(const Stream& stream, std::size_t i, Value where_none) const;
    bool exists(std::uint32_t lag) const { return steps_ >= lag && finished_ <= lag; }
    /// Returns the steps since the trace or this monitor began.
    std::uint64_t steps_since(std::uint32_t begins_with) const {
        return begins_with == kNone ? steps_ : steps_ - starts_[begins_with];
    }
    void advance_readings();
    etlmon::Reading advance(const Reading& reading, ReadingState& state) const;
    etlmon::Reading run(const Straight& code, ReadingState& state, std::uint64_t position) const;
    etlmon::Reading run(const Table& table, ReadingState& state) const;
    Value value(const Term& term, const ReadingState& state, std::uint64_t position) const;
    void judge();

    const Plan& plan_;
    const check::Model& model_;
    std::vector<Index> measured_points_;      ///< points of the model, each after its inner one
    std::vector<std::vector<float>> points_;  ///< per point: memory of vectors and projections
    std::vector<const float*> point_at_;      ///< per point: its elements; null: unknown
    std::vector<float> centred_;              ///< scratch of a projection
    std::vector<EarlierSamples> earlier_;     ///< of the points that some point delays
    bool points_are_kept_ = false;            ///< those of this step are among the earlier ones
    /// Per target and distance: prepared rows.
    std::vector<std::vector<float>> prepared_;
    /// For distances by full weights to the nearest row: candidate rows, and room for their values.
    mutable std::map<Index, NearRows> near_;
    std::vector<float> near_values_;
    /// Per distance: its narrow rows, widened.
    std::vector<std::vector<float>> widened_;
    std::vector<const float*>
        inputs_;  ///< per input of the model: this step's values; null: missing
    std::vector<Held> held_;
    std::vector<Freshness> freshness_;  ///< per input of the model
    std::vector<SampleCounts> counts_;
    std::vector<etlmon::Measured> distances_;
    /// Per distance: the same, with bounds for narrow targets.
    std::vector<etlmon::Enclosed> enclosed_;
    /// Per predicate: where its difference changes the comparison, for narrow targets.
    std::vector<std::vector<Cut>> contrast_cuts_;
    /// Per predicate: the nearest rows of its two distances, where it has such cuts.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> contrast_rows_;
    std::vector<PastState> past_states_;  ///< as plan.pasts
    std::vector<float> pasts_;            ///< per past number of the model: at this step
    std::vector<float> past_operands_;    ///< likewise: its expression
    std::vector<etlmon::Measured> measured_;
    std::vector<float> scratch_;
    std::vector<float> thresholds_;        ///< per predicate
    std::vector<Value> predicate_values_;  ///< per predicate
    PredicateValue replacement_;
    std::function<void()> after_pasts_;
    std::vector<Value> flags_;  ///< per input
    std::vector<Value> streams_;
    std::vector<StreamState> stream_states_;
    std::vector<etlmon::Reading> readings_;
    std::vector<ReadingState> reading_states_;
    std::vector<etlmon::Verdict> verdicts_;
    std::vector<etlmon::Verdict> lets_;
    std::uint64_t steps_ = 0;            ///< index of the current step, calls of finish() included
    std::vector<std::uint64_t> starts_;  ///< per monitor: its position
    std::vector<bool> restarts_;         ///< per monitor: whether it restarts with the next step
    bool started_ = false;
    std::uint32_t finished_ = 0;  ///< calls of finish()
    std::uint32_t missing_steps_ = 0;
};

}  // namespace etlc::plan
