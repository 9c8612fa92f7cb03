// Tables of labels: .csv files in which each row labels a predicate in steps of an episode.
// Takes: the bytes of a file. Gives: its rows, with their lines. Keeps true: a row is read exactly
// or refused; names of episodes and predicates are those of the file, which labels.hpp looks up.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::episodes {

/// Ordered: && is the minimum, || the maximum, unknown in between (Kleene's strong logic).
enum class Label : std::uint8_t { no, unknown, yes };

/// The predicate has this label from `start` up to but excluding `end`.
struct LabelRow {
    std::string episode;
    std::string predicate;  ///< without its mark; empty where the row only gives the group
    Label label = Label::yes;
    double start = 0;  ///< in steps or seconds
    double end = std::numeric_limits<double>::infinity();
    std::string group;  ///< empty: none
    std::uint32_t line = 0;
};

struct LabelTable {
    bool in_seconds = false;  ///< unit of `start` and `end`
    std::vector<LabelRow> rows;
};

/// Reads a table. Failures: E0803; E0860, which names the column, what was found and what was
/// expected.
diag::Result<LabelTable> parse_labels(std::unique_ptr<data::ByteSource> source);

}  // namespace etlc::episodes
