// The flight recorder beside the evaluator.
// Takes: a plan with a recorder, and the evaluator after each of its steps. Gives: the incidents
// that the generated class gives on the same samples, byte for byte. A Boolean class measures a
// predicate when a verdict asks for it, and records which it asked for; here all are measured.
// Keeps true: all memory is asked for when it is made.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/evaluate/evaluator.hpp"
#include "plan/evaluate/recorder_storage.hpp"
#include "plan/recorder.hpp"

namespace etlc::plan {

class FlightRecorder {
public:
    explicit FlightRecorder(const Plan& plan);

    /// After Evaluator::step().
    void step(const Evaluator& evaluator, const std::vector<etlmon::Verdict>& verdicts);
    /// After Evaluator::finish().
    void finish(const std::vector<etlmon::Verdict>& verdicts);
    /// Evaluator::restart() was called.
    void restart(std::size_t monitor) { recorder_.restart(static_cast<std::uint32_t>(monitor)); }
    /// Evaluator::reset() was called.
    void end_episode() { recorder_.end_episode(); }

    std::uint32_t complete() const { return recorder_.complete(); }
    std::uint32_t lost() const { return recorder_.lost(); }
    void close() { recorder_.close(); }
    void forget() { recorder_.forget(); }

    /// The bytes of a complete incident, good until the next call.
    const std::vector<std::uint8_t>& write(std::uint32_t incident);

private:
    void fill(const Evaluator& evaluator);
    void record(const RecorderRow& row, const std::vector<etlmon::Verdict>& verdicts);

    const Plan& plan_;
    RecorderColumns columns_;
    etlmon::IncidentOrigin origin_;
    RecorderRow unasked_;
    RecorderRow row_;
    std::vector<std::uint32_t> statuses_;
    etlmon::RecorderIn<RecorderStorage> recorder_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace etlc::plan
