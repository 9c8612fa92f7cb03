// What monitors of a plan remember from one step to the next. One plan can step many states. States
// of one plan have the same shape, so that one can be assigned to another without allocating
// memory, and all memory of a step is allocated by the constructor.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/distance/aggregate.hpp"
#include "etlmon/past/numbers.hpp"
#include "etlmon/temporal/drift.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/monoid.hpp"
#include "etlmon/temporal/pending.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "execute/inputs.hpp"
#include "plan/program/program.hpp"
#include "plan/program/reading.hpp"

namespace etlc::execute {

// The samples of a point at earlier steps, as etlmon/past/points.hpp keeps them; in float32, which
// has every float16 and every scaled int8 that an input can have.

class EarlierSamples {
public:
    EarlierSamples(check::Index point, std::uint32_t steps, std::uint32_t dimension)
        : point_(point),
          dimension_(dimension),
          samples_(std::size_t{steps} * dimension),
          present_(steps) {}

    check::Index point() const { return point_; }
    void reset() {
        next_ = 0;
        present_.assign(present_.size(), false);
    }
    /// Returns the sample of `ago` steps before the one that is pushed next; null if there is none.
    const float* at(std::uint32_t ago) const {
        const std::size_t slot = (next_ + present_.size() - ago) % present_.size();
        return present_[slot] ? samples_.data() + slot * dimension_ : nullptr;
    }
    /// Adds the sample of this step; null if it is missing.
    void push(const float* sample) {
        if (sample != nullptr)
            std::copy_n(sample, dimension_,
                        samples_.begin() + static_cast<std::ptrdiff_t>(next_ * dimension_));
        present_[next_] = sample != nullptr;
        next_ = (next_ + 1) % present_.size();
    }

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        archive.number(self.next_);
        archive.fixed(self.samples_);
        archive.bools(self.present_);
    }
    bool fits() const { return next_ < present_.size(); }

private:
    check::Index point_;
    std::uint32_t dimension_;
    std::size_t next_ = 0;
    std::vector<float> samples_;
    std::vector<bool> present_;
};

// The state of a number that earlier steps have a part in, with the runtime's arithmetic: the bits
// of generated code. Memory is allocated by the constructor.

class PastState {
public:
    explicit PastState(const check::Past& past);

    void reset();
    /// Takes the value of its expression at this step, NaN where it is missing. Returns the number.
    float push(float x);

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        archive.fixed(self.bits_);
        archive.fixed(self.keys_);
        archive.number(self.mean_);
        archive.number(self.cursor_);
        archive.number(self.count_);
    }
    /// Returns whether all cursors are inside, as after any number of steps.
    bool fits() const;

private:
    using Kind = check::Past::Kind;

    Kind kind_;
    std::uint32_t steps_;
    std::vector<std::uint32_t> bits_;  ///< of a delay or mean
    std::vector<etlmon::Key> keys_;    ///< of a min or max
    etlmon::MeanState mean_{};
    std::uint32_t cursor_ = 0;
    std::uint32_t count_ = 0;
};

// Executes a pending reading of a plan, which outlives it.

/// Executes a pending reading: evaluates the last positions of the prefix again at every step, in
/// constant memory, with the runtime loops of generated code.
class PendingEvaluator {
public:
    explicit PendingEvaluator(const plan::Pending& pending);
    PendingEvaluator(const PendingEvaluator&) = default;
    /// Takes what another evaluator of the same reading remembers.
    PendingEvaluator& operator=(const PendingEvaluator& other) {
        leaves_ = other.leaves_;
        registers_ = other.registers_;
        return *this;
    }
    ~PendingEvaluator() = default;

    void reset();
    /// `position`: of the step, from the start; `streams`: all values at it.
    etlmon::Reading advance(std::uint64_t position, const std::vector<etlmon::Value>& streams);

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        for (auto& leaf : self.leaves_) archive.some(leaf);
        archive.fixed(self.registers_);
    }
    bool fits() const;

private:
    using Readings = std::vector<etlmon::Reading>;

    void evaluate_parts(std::uint32_t count, const std::vector<etlmon::Value>& streams);
    void evaluate_part(std::size_t index, std::uint32_t count,
                       const std::vector<etlmon::Value>& streams);
    etlmon::Reading advance_fold(std::uint32_t step, std::uint32_t count,
                                 const std::vector<etlmon::Value>& streams);
    etlmon::Reading advance_machine(std::uint32_t step, std::uint32_t count,
                                    const std::vector<etlmon::Value>& streams);

    const plan::Pending* pending_;
    /// Per part: the last horizon + 1 values, oldest first.
    std::vector<std::vector<etlmon::Value>> leaves_;
    std::vector<Readings> parts_;           ///< per part: at the same positions
    std::vector<etlmon::Value> registers_;  ///< of settled positions
    // scratch of a machine: guards by position, keys of its lists, registers
    Readings guards_;
    std::vector<etlmon::Key> weak_;
    std::vector<etlmon::Key> strong_;
    Readings scratch_;
    std::vector<etlmon::Value> values_;
};

/// Counts of the samples of one input since reset().
struct SampleCounts {
    std::uint64_t missing = 0;       ///< absent, or not finite
    std::uint64_t out_of_range = 0;  ///< a scalar out of its declared range: counts as missing
    std::uint64_t stale = 0;         ///< repeated too often: counts as missing
    std::uint64_t held = 0;          ///< of all these, those replaced by `hold`
};

/// A point whose samples of earlier steps are kept, and of how many.
struct KeptPoint {
    check::Index point = 0;
    std::uint32_t steps = 0;
};

/// How states of a plan begin.
struct Shape {
    std::vector<KeptPoint> kept;  ///< points whose earlier samples are read
    std::vector<std::vector<plan::Member>>
        streams;  ///< per stream: members with their first values
    std::vector<std::vector<etlmon::Value>>
        registers;  ///< per reading: first ones of straight-line code
};

struct State {
    struct Held {
        std::vector<float> values;  ///< of an input with `hold`; empty: none yet
        std::uint32_t age = 0;
    };
    struct OfStream {
        std::vector<etlmon::Value> values;
        std::vector<etlmon::Key> lows;  ///< the ends of the values of a count, sorted
        std::vector<etlmon::Key> highs;
        std::vector<etlmon::Since<etlmon::Value>::Element> pairs;
        std::vector<etlmon::Handover<etlmon::Value>::Element> flanks;
        std::uint32_t cursor = 0;

        /// Sorts the ends of the values, where they are counted.
        void sort_counted();
    };
    struct OfReading {
        std::vector<etlmon::Value>
            registers;                    ///< of straight-line code, or one per state of a table
        std::vector<etlmon::Value> next;  ///< locals, or the next registers of a table
        std::vector<etlmon::Value> guards;
        std::vector<etlmon::Key> weak;  ///< this step's keys in the table's lists
        std::vector<etlmon::Key> strong;
        std::optional<PendingEvaluator> pending;
    };

    State(const plan::Plan& plan, const Shape& shape);

    /// Begins an episode. Thresholds stay, and so does what drifts know of episodes that ended.
    void reset(const plan::Plan& plan, const Shape& shape);
    void reset_stream(plan::Slot stream, const Shape& shape);
    void reset_reading(std::size_t reading, const plan::Plan& plan, const Shape& shape);

    /// Writes it as bytes for a state of the same plan, in this machine's byte order.
    void write(std::vector<std::uint8_t>& bytes) const;
    /// Reads what write() has written, and removes it from `bytes`. Returns whether it can be a
    /// state of this plan; else this state must not be stepped.
    bool read(std::span<const std::uint8_t>& bytes, const plan::Plan& plan, const Shape& shape);

    std::vector<Held> held;            ///< per input of the model
    std::vector<Freshness> freshness;  ///< per input of the model
    std::vector<EarlierSamples> earlier;
    std::vector<SampleCounts> counts;        ///< per input of the model
    std::vector<PastState> pasts;            ///< as plan.pasts
    std::vector<etlmon::Measured> measured;  ///< per predicate of the model
    /// Per predicate: the nearest rows of its two distances, where narrow rows leave it open.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> contrast_rows;
    std::vector<float> thresholds;                ///< per predicate
    std::vector<etlmon::Drift> drifts;            ///< as plan.drifts
    std::vector<etlmon::Value> predicate_values;  ///< per predicate
    std::vector<etlmon::Value> flags;             ///< per input
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
    bool fits(const plan::Plan& plan, const Shape& shape) const;
};

}  // namespace etlc::execute
