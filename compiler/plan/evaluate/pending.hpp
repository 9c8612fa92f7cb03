// Executes a pending reading of a plan, which outlives it.
#pragma once

#include <cstdint>
#include <vector>

#include "etlmon/temporal/pending.hpp"
#include "etlmon/temporal/reading.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

/// Executes a pending reading: evaluates the last positions of the prefix again at every step, in
/// constant memory, with the runtime loops of generated code.
class PendingEvaluator {
public:
    explicit PendingEvaluator(const Pending& pending);
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
    etlmon::Reading advance(std::uint64_t position, const std::vector<Value>& streams);

    /// Passes its numbers to an archive (archive.hpp).
    template <class Self, class Archive>
    static void visit(Self& self, Archive& archive) {
        for (auto& leaf : self.leaves_) archive.some(leaf);
        archive.fixed(self.registers_);
    }
    bool fits() const;

private:
    using Readings = std::vector<etlmon::Reading>;

    void evaluate_parts(std::uint32_t count, const std::vector<Value>& streams);
    void evaluate_part(std::size_t index, std::uint32_t count, const std::vector<Value>& streams);
    etlmon::Reading advance_fold(std::uint32_t step, std::uint32_t count,
                                 const std::vector<Value>& streams);
    etlmon::Reading advance_machine(std::uint32_t step, std::uint32_t count,
                                    const std::vector<Value>& streams);

    const Pending* pending_;
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

}  // namespace etlc::plan
