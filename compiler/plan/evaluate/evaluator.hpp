// The plan, executed: what `etlc run` and calibration step.
// Takes: a plan and one sample of every input a step. Gives: the verdicts and telemetry that the
// generated class gives, from the same runtime code. Keeps true: all memory is asked for when it is
// made, work per step is independent of history.
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
#include "plan/evaluate/inputs.hpp"
#include "plan/evaluate/near_rows.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Executes a pending reading: evaluates the last positions of the prefix again at every step, in
/// constant memory, with the runtime loops of generated code.
class PendingEvaluator {
public:
    explicit PendingEvaluator(const Pending& pending);

    void reset();
    /// position: of the step, from the start; streams: the values of all streams at it.
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
    std::vector<Value> registers_;  ///< where everything is settled
    // Of a machine, room for a step: guards by position, keys of its lists, registers.
    Readings guards_;
    std::vector<Key> weak_;
    std::vector<Key> strong_;
    Readings scratch_;
    std::vector<Value> values_;
};

/// What became of the samples of one input since reset().
struct SampleCounts {
    std::uint64_t missing = 0;  ///< not there, or not finite
    std::uint64_t out_of_range =
        0;                   ///< a scalar beyond its declared range, which counts as missing
    std::uint64_t held = 0;  ///< of both: where the last one stood in
};

class Evaluator {
public:
    explicit Evaluator(const Plan& plan);

    void reset();
    /// One time step; `samples` by index of the model's inputs (those that no monitor depends on
    /// are not looked at). The verdicts are by index of plan.monitors and good until the next call.
    const std::vector<etlmon::Verdict>& step(const std::vector<Sample>& samples);
    /// The trace has ended: sliding monitors report one of their last positions per call, prefix
    /// monitors their last verdict.
    const std::vector<etlmon::Verdict>& finish();

    /// What each let of the plan said of the last step.
    const std::vector<etlmon::Verdict>& lets() const { return lets_; }

    /// From the next step on, this monitor of the plan is about that step.
    void restart(std::size_t monitor);
    /// The position that the verdict of the last step is about, where it is decided.
    std::uint64_t position(std::size_t monitor) const;

    /// delta of the last step, by index of the model's predicates; NaN where it was unknown.
    float distance(Index predicate) const { return measured_[predicate].delta; }
    /// Row of the nearest target; plain distances only.
    std::uint32_t nearest(Index predicate) const { return measured_[predicate].nearest; }
    /// The same of any predicate, for each of its distances.
    std::uint32_t nearest(Index predicate, Index distance) const;
    std::uint32_t missing_steps() const { return missing_steps_; }
    /// By index of the model's inputs; those that no monitor depends on are not counted.
    const std::vector<SampleCounts>& sample_counts() const { return counts_; }

    /// The threshold that the next step uses. An adaptive one moves with the labels that observe()
    /// is given and, as in generated code, stays through reset(); nobody but its caller gives
    /// labels, so `etlc run` has the one that was calibrated.
    float threshold(Index predicate) const { return thresholds_[predicate]; }
    void observe(Index predicate, float distance, bool truth);

    /// What the predicates of the last step were computed from: an input's values after `hold`,
    /// null where it is missing, and a distance with its nearest row, by index in the model.
    const float* input(Index input) const { return inputs_[input]; }
    etlmon::Measured measured(Index distance) const { return distances_[distance]; }
    /// The elements of a point of the model from which the plan measures; null where it is unknown.
    const float* point(Index point) const { return point_at_[point]; }
    /// Of a distance by full weights to its nearest row: the rows that may be nearest to z (see
    /// near_rows.hpp).
    const std::vector<std::uint32_t>& near_rows(Index distance, const float* z,
                                                double margin) const {
        return near_.at(distance).of(z, margin);
    }

    /// From now on formulas see, of predicates that are measured, this instead of their robustness:
    /// calibration reckons with what other builds measure. Both ends go through formulas
    /// independently; a negation exchanges them.
    using PredicateValue = std::function<Value(Index predicate)>;
    void replace_predicate_values(PredicateValue value) { replacement_ = std::move(value); }

private:
    struct Held {
        std::vector<float> values;  ///< empty: nothing to hold
        std::uint32_t age = 0;
    };
    struct StreamState {
        std::vector<Member> members;  ///< what is kept, as it begins
        std::vector<Value> values;
        std::vector<etlmon::Since<Value>::Element> pairs;
        std::vector<etlmon::Handover<Value>::Element> flanks;
        std::uint32_t cursor = 0;
    };
    struct ReadingState {
        std::vector<Value> registers;  ///< of straight-line code; of a table, one a state
        std::vector<Value> next;       ///< locals; of a table, the registers being made
        std::vector<Value> guards;
        std::vector<Key> weak;  ///< this step's keys of the table's lists
        std::vector<Key> strong;
        std::vector<Value> first;  ///< of the registers of straight-line code
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
    void measure_distances();
    void measure_predicates();
    etlmon::Enclosed measure(Index distance, const float* z);
    etlmon::Measured measure_wide(Index distance, const float* z);
    etlmon::Enclosed measure_contrast(const check::Predicate& predicate);
    etlmon::Measured measure_near(Index distance, const float* z);
    float expression(const check::Expr& e) const;
    void advance_streams();
    Value advance(const Stream& stream, StreamState& state) const;
    Value advance_window(const Stream& stream, StreamState& state) const;
    Value operand(const Stream& stream, std::size_t i, Value where_none) const;
    bool exists(std::uint32_t lag) const { return steps_ >= lag && finished_ <= lag; }
    /// Steps since the trace or this monitor began.
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
    std::vector<Index> measured_points_;      ///< of the model, each behind its inner one
    std::vector<std::vector<float>> points_;  ///< per point: where vectors and projections lie
    std::vector<const float*> point_at_;      ///< per point: its elements; null: unknown
    std::vector<float> centred_;              ///< scratch of a projection
    /// Per target and distance: rows as the kernels want them.
    std::vector<std::vector<float>> prepared_;
    /// Of distances by full weights to the nearest row, the rows that have to be measured, and room
    /// for them.
    mutable std::map<Index, NearRows> near_;
    std::vector<float> near_values_;
    /// Per distance: what its narrow rows stand for, where it has some.
    std::vector<std::vector<float>> widened_;
    std::vector<const float*>
        inputs_;  ///< per input of the model: this step's values; null: missing
    std::vector<Held> held_;
    std::vector<SampleCounts> counts_;
    std::vector<etlmon::Measured> distances_;
    /// Per distance: the same, with what narrow targets leave open.
    std::vector<etlmon::Enclosed> enclosed_;
    /// Per predicate: where the difference turns that narrow targets leave open.
    std::vector<std::vector<Cut>> contrast_cuts_;
    /// Per predicate: the nearest rows of its two distances, where it has such cuts.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> contrast_rows_;
    std::vector<etlmon::Measured> measured_;
    std::vector<float> scratch_;
    std::vector<float> thresholds_;        ///< per predicate
    std::vector<Value> predicate_values_;  ///< per predicate
    PredicateValue replacement_;
    std::vector<Value> flags_;  ///< per input
    std::vector<Value> streams_;
    std::vector<StreamState> stream_states_;
    std::vector<etlmon::Reading> readings_;
    std::vector<ReadingState> reading_states_;
    std::vector<etlmon::Verdict> verdicts_;
    std::vector<etlmon::Verdict> lets_;
    std::uint64_t steps_ = 0;            ///< index of the current step, calls of finish() included
    std::vector<std::uint64_t> starts_;  ///< per monitor: the position that it is about
    std::vector<bool> restarts_;         ///< per monitor: with the next step
    bool started_ = false;
    std::uint32_t finished_ = 0;  ///< calls of finish()
    std::uint32_t missing_steps_ = 0;
};

}  // namespace etlc::plan
