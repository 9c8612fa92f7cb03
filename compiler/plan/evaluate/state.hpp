// What monitors of a plan remember from one step to the next. One plan can step many states. States
// of one plan have the same shape, so that one can be assigned to another without allocating
// memory, and all memory of a step is allocated by the constructor.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "etlmon/distance/aggregate.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/monoid.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "plan/evaluate/earlier_samples.hpp"
#include "plan/evaluate/inputs.hpp"
#include "plan/evaluate/past_state.hpp"
#include "plan/evaluate/pending.hpp"
#include "plan/program/program.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

/// Counts of the samples of one input since reset().
struct SampleCounts {
    std::uint64_t missing = 0;       ///< absent, or not finite
    std::uint64_t out_of_range = 0;  ///< a scalar out of its declared range: counts as missing
    std::uint64_t stale = 0;         ///< repeated too often: counts as missing
    std::uint64_t held = 0;          ///< of all these, those replaced by `hold`
};

/// A point whose samples of earlier steps are kept, and of how many.
struct KeptPoint {
    Index point = 0;
    std::uint32_t steps = 0;
};

/// How states of a plan begin.
struct Shape {
    std::vector<KeptPoint> kept;                ///< points whose earlier samples are read
    std::vector<std::vector<Member>> streams;   ///< per stream: members with their first values
    std::vector<std::vector<Value>> registers;  ///< per reading: first ones of straight-line code
};

struct State {
    struct Held {
        std::vector<float> values;  ///< of an input with `hold`; empty: none yet
        std::uint32_t age = 0;
    };
    struct OfStream {
        std::vector<Value> values;
        std::vector<Key> lows;  ///< the ends of the values of a count, sorted
        std::vector<Key> highs;
        std::vector<etlmon::Since<Value>::Element> pairs;
        std::vector<etlmon::Handover<Value>::Element> flanks;
        std::uint32_t cursor = 0;

        /// Sorts the ends of the values, where they are counted.
        void sort_counted();
    };
    struct OfReading {
        std::vector<Value> registers;  ///< of straight-line code, or one per state of a table
        std::vector<Value> next;       ///< locals, or the next registers of a table
        std::vector<Value> guards;
        std::vector<Key> weak;  ///< this step's keys in the table's lists
        std::vector<Key> strong;
        std::optional<PendingEvaluator> pending;
    };

    State(const Plan& plan, const Shape& shape);

    /// Begins an episode. Thresholds stay.
    void reset(const Plan& plan, const Shape& shape);
    void reset_stream(Slot stream, const Shape& shape);
    void reset_reading(std::size_t reading, const Plan& plan, const Shape& shape);

    /// Writes it as bytes for a state of the same plan, in this machine's byte order.
    void write(std::vector<std::uint8_t>& bytes) const;
    /// Reads what write() has written, and removes it from `bytes`. Returns whether it can be a
    /// state of this plan; else this state must not be stepped.
    bool read(std::span<const std::uint8_t>& bytes, const Plan& plan, const Shape& shape);

    std::vector<Held> held;            ///< per input of the model
    std::vector<Freshness> freshness;  ///< per input of the model
    std::vector<EarlierSamples> earlier;
    std::vector<SampleCounts> counts;        ///< per input of the model
    std::vector<PastState> pasts;            ///< as plan.pasts
    std::vector<etlmon::Measured> measured;  ///< per predicate of the model
    /// Per predicate: the nearest rows of its two distances, where narrow rows leave it open.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> contrast_rows;
    std::vector<float> thresholds;        ///< per predicate
    std::vector<Value> predicate_values;  ///< per predicate
    std::vector<Value> flags;             ///< per input
    std::vector<OfStream> streams;
    std::vector<OfReading> readings;
    std::vector<etlmon::Verdict> verdicts;  ///< per monitor of the plan
    std::vector<etlmon::Verdict> lets;
    std::uint64_t steps = 0;            ///< index of the current step, calls of finish() included
    std::vector<std::uint64_t> starts;  ///< per monitor: its position
    std::vector<bool> restarts;         ///< per monitor: whether it restarts with the next step
    bool started = false;
    std::uint32_t finished = 0;  ///< calls of finish()
    std::uint32_t missing_steps = 0;

    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive);

private:
    bool fits(const Plan& plan, const Shape& shape) const;
};

}  // namespace etlc::plan
