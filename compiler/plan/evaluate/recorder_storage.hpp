// Where a flight recorder whose sizes are known at run time keeps its rows.
// Takes: how many figures, bools and verdicts a step has, and how many steps and incidents are
// kept. Gives: storage with which etlmon::RecorderIn gives the incidents that etlmon::Recorder of
// these sizes gives, byte for byte. Keeps true: all memory is asked for when it is made.
#pragma once

#include <cstdint>
#include <vector>

#include "etlmon/temporal/recorder.hpp"

namespace etlc::plan {

struct RecorderSizes {
    std::uint32_t figures = 0;
    std::uint32_t bools = 0;
    std::uint32_t monitors = 0;
    std::uint32_t before = 0;
    std::uint32_t after = 0;
    std::uint32_t incidents = 0;
};

/// As etlmon::RecorderRow.
struct RecorderRow : etlmon::RowCalls<RecorderRow> {
    std::vector<std::uint32_t> words;
    std::vector<std::uint8_t> bytes;

    /// A step at which nobody asked for anything.
    explicit RecorderRow(const RecorderSizes& sizes)
        : words(1 + sizes.figures, etlmon::kUnaskedBits),
          bytes((sizes.bools + sizes.monitors + 3) / 4 * 4) {
        words[0] = 0;
        for (std::uint32_t i = 0; i < sizes.bools; ++i) bytes[i] = etlmon::kRecordedUnasked;
    }
};

/// As etlmon::RecorderArrays.
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

}  // namespace etlc::plan
