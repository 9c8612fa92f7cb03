// A pending reading, executed: the last positions of the prefix again at every step.
// Takes: this step's streams. Gives: the reading. Keeps true: constant memory; the same runtime
// loops as generated code.
#pragma once

#include <cstdint>
#include <vector>

#include "etlmon/temporal/pending.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

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

}  // namespace etlc::plan
