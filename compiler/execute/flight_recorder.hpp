// Records incidents beside the evaluator, byte for byte those of the generated class on the same
// samples. One difference: a Boolean class measures and records predicates on demand of a verdict;
// here all are measured. All memory is allocated by the constructor.
#pragma once

#include <cstdint>
#include <vector>

#include "etlmon/temporal/recorder.hpp"
#include "execute/evaluator.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::execute {

struct RecorderSizes {
    std::uint32_t figures = 0;
    std::uint32_t bools = 0;
    std::uint32_t monitors = 0;
    std::uint32_t before = 0;
    std::uint32_t after = 0;
    std::uint32_t incidents = 0;
};

/// Mirrors etlmon::RecorderRow.
struct RecorderRow : etlmon::RowCalls<RecorderRow> {
    std::vector<std::uint32_t> words;
    std::vector<std::uint8_t> bytes;

    /// Makes the row of a step without queries.
    explicit RecorderRow(const RecorderSizes& sizes)
        : words(1 + sizes.figures, etlmon::kUnaskedBits),
          bytes((sizes.bools + sizes.monitors + 3) / 4 * 4) {
        words[0] = 0;
        for (std::uint32_t i = 0; i < sizes.bools; ++i) bytes[i] = etlmon::kRecordedUnasked;
    }
};

/// Mirrors etlmon::RecorderArrays, for sizes known at run time.
class RecorderStorage {
public:
    using Row = RecorderRow;
    using Statuses = std::vector<std::uint32_t>;

    explicit RecorderStorage(const RecorderSizes& sizes)
        : alarms((sizes.monitors + 31) / 32),
          incidents(sizes.incidents),
          ring(std::size_t{sizes.before} + 1, Row(sizes)),
          log(sizes.incidents * (std::size_t{sizes.before} + 1 + sizes.after), Row(sizes)),
          sizes_(sizes) {}

    std::uint32_t before() const noexcept { return sizes_.before; }
    std::uint32_t after() const noexcept { return sizes_.after; }
    std::uint32_t most_incidents() const noexcept { return sizes_.incidents; }
    std::uint32_t bools() const noexcept { return sizes_.bools; }
    std::uint32_t monitors() const noexcept { return sizes_.monitors; }
    std::uint32_t row_words() const noexcept { return 1 + sizes_.figures; }

    std::vector<std::uint32_t> alarms;
    std::vector<etlmon::RecordedIncident> incidents;
    std::vector<Row> ring;
    std::vector<Row> log;

private:
    RecorderSizes sizes_;
};

class FlightRecorder {
public:
    explicit FlightRecorder(const plan::Plan& plan);

    /// Records a step; call it after Evaluator::step().
    void step(const Evaluator& evaluator, const std::vector<etlmon::Verdict>& verdicts);
    /// Records a final position; call it after Evaluator::finish().
    void finish(const std::vector<etlmon::Verdict>& verdicts);
    /// Call it after Evaluator::restart().
    void restart(std::size_t monitor) { recorder_.restart(static_cast<std::uint32_t>(monitor)); }
    /// Call it after Evaluator::reset().
    void end_episode() { recorder_.end_episode(); }

    std::uint32_t complete() const { return recorder_.complete(); }
    std::uint32_t lost() const { return recorder_.lost(); }
    void close() { recorder_.close(); }
    void forget() { recorder_.forget(); }

    /// Returns the bytes of a complete incident, valid until the next call.
    const std::vector<std::uint8_t>& write(std::uint32_t incident);

private:
    void fill(const Evaluator& evaluator);
    void record(const RecorderRow& row, const std::vector<etlmon::Verdict>& verdicts);

    const plan::Plan& plan_;
    plan::RecorderColumns columns_;
    etlmon::IncidentOrigin origin_;
    RecorderRow unasked_;
    RecorderRow row_;
    std::vector<std::uint32_t> statuses_;
    etlmon::RecorderIn<RecorderStorage> recorder_;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace etlc::execute
