#include "episodes/labels/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "data/text/text.hpp"
#include "data/traces/csv.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::episodes {

namespace {

using diag::Code;
using diag::Failure;

/// The largest step: every whole number up to it is a double.
constexpr std::uint64_t kLastStep = std::uint64_t{1} << 53U;

/// The index of each column; kNone for one that the table lacks.
struct LabelColumns {
    static constexpr std::size_t kNone = SIZE_MAX;

    std::size_t episode = kNone;
    std::size_t predicate = kNone;
    std::size_t start = kNone;
    std::size_t end = kNone;
    std::size_t group = kNone;
    std::size_t outcome = kNone;
    bool in_seconds = false;
    std::size_t count = 0;
};

diag::Result<LabelColumns> label_columns(const data::CsvReader& header) {
    const std::vector<std::string> known{"episode", "predicate", "start", "end",
                                         "start_s", "end_s",     "group", "outcome"};
    std::vector<std::size_t> at(known.size(), LabelColumns::kNone);
    for (std::size_t i = 0; i < header.cells(); ++i) {
        const std::string name(header.cell(i));
        const auto fail = [&](const std::string& why) {
            return Failure{Code::malformed_labels,
                           fmt::format("column {} {}", data::in_quotes(name), why), header.line(i),
                           header.column(i)};
        };
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            const std::string meant = data::suggestion(name, known);
            return fail("is unknown" +
                        (meant.empty() ? "; expected " + data::listed(known) : meant));
        }
        std::size_t& place = at[static_cast<std::size_t>(found - known.begin())];
        if (place != LabelColumns::kNone) return fail("occurs twice");
        place = i;
    }
    const auto fail = [&](const std::string& why) {
        return Failure{Code::malformed_labels, why, header.row_line(), 1};
    };
    const auto has = [&](std::size_t column) { return at[column] != LabelColumns::kNone; };
    for (const std::size_t needed : {std::size_t{0}, std::size_t{1}})
        if (!has(needed) && (needed == 0 || !has(7)))
            return fail(
                fmt::format("no column '{}'; a table of labels has the columns episode and "
                            "predicate, and for intervals start and end, or start_s and end_s; "
                            "one of outcomes has episode and outcome",
                            known[needed]));
    if (has(2) != has(3) || has(4) != has(5))
        return fail("start and end, or start_s and end_s, come together");
    if (has(2) && has(4)) return fail("has both steps (start, end) and seconds (start_s, end_s)");
    LabelColumns columns{at[0], at[1], has(4) ? at[4] : at[2], has(4) ? at[5] : at[3],
                         at[6], at[7]};
    columns.in_seconds = has(4);
    columns.count = header.cells();
    return columns;
}

/// Reads the rows of a table, one at a time.
class LabelRows {
public:
    LabelRows(data::CsvReader& cells, const LabelColumns& columns)
        : cells_(cells), columns_(columns) {}

    diag::Result<LabelRow> row() const {
        LabelRow row;
        row.line = cells_.row_line();
        if (cells_.cells() != columns_.count)
            return Failure{Code::malformed_csv, data::other_cells(cells_.cells(), columns_.count),
                           row.line, 1};
        row.episode = cells_.cell(columns_.episode);
        if (row.episode.empty()) return fail(columns_.episode, "names no episode");
        if (columns_.group != LabelColumns::kNone) row.group = cells_.cell(columns_.group);
        if (auto failure = read_outcome(row)) return *failure;
        if (auto failure = read_predicate(row)) return *failure;
        if (columns_.start == LabelColumns::kNone) return row;
        if (auto failure = read_bound(columns_.start, row.start)) return *failure;
        if (auto failure = read_bound(columns_.end, row.end)) return *failure;
        if (row.outcome != Outcome::Kind::none &&
            (std::isfinite(row.end) || (row.start > 0 && row.outcome != Outcome::Kind::failure)))
            return fail(std::isfinite(row.end) ? columns_.end : columns_.start,
                        "an outcome has no end, and only a failure has a start");
        if (row.start < row.end) return row;
        return fail(columns_.end,
                    fmt::format("ends at {} and begins at {}: an interval excludes its end",
                                row.end, row.start));
    }

private:
    Failure fail(std::size_t column, std::string why) const {
        return {Code::malformed_labels, std::move(why), cells_.line(column), cells_.column(column)};
    }

    std::optional<Failure> read_outcome(LabelRow& row) const {
        if (columns_.outcome == LabelColumns::kNone || cells_.empty(columns_.outcome))
            return std::nullopt;
        const std::string_view cell = cells_.cell(columns_.outcome);
        for (const Outcome::Kind kind :
             {Outcome::Kind::unknown, Outcome::Kind::success, Outcome::Kind::failure})
            if (cell == name_of(kind)) row.outcome = kind;
        if (row.outcome == Outcome::Kind::none)
            return fail(columns_.outcome,
                        fmt::format("found {}, expected success, failure or unknown",
                                    data::in_quotes(cell)));
        if (columns_.predicate == LabelColumns::kNone || cells_.empty(columns_.predicate))
            return std::nullopt;
        return fail(columns_.outcome,
                    "an outcome stands in a row of its own, which names no predicate");
    }

    std::optional<Failure> read_predicate(LabelRow& row) const {
        if (row.outcome != Outcome::Kind::none) return std::nullopt;
        if (columns_.predicate == LabelColumns::kNone)
            return fail(columns_.outcome, "names no outcome; expected success, failure or unknown");
        std::string_view name = cells_.cell(columns_.predicate);
        if (name.starts_with('?')) row.label = Label::unknown;
        if (name.starts_with('!')) row.label = Label::no;
        if (row.label != Label::yes) name.remove_prefix(1);
        row.predicate = name;
        if (!name.empty()) return std::nullopt;
        const bool gives_group = row.label == Label::yes && !row.group.empty() &&
                                 (columns_.start == LabelColumns::kNone ||
                                  (cells_.empty(columns_.start) && cells_.empty(columns_.end)));
        if (gives_group) return std::nullopt;
        return fail(columns_.predicate, "names no predicate; expected NAME, ?NAME or !NAME");
    }

    /// An empty cell leaves `bound` as it is.
    std::optional<Failure> read_bound(std::size_t column, double& bound) const {
        if (cells_.empty(column)) return std::nullopt;
        const std::string_view cell = cells_.cell(column);
        if (columns_.in_seconds) {
            const auto seconds = cells_.number(column);
            if (!seconds || !std::isfinite(*seconds) || *seconds < 0)
                return fail(column,
                            fmt::format("found {}, expected seconds from 0: {}",
                                        data::in_quotes(cell), cells_.expected_number(column)));
            bound = *seconds;
            return std::nullopt;
        }
        const auto step = data::parse_whole<std::uint64_t>(cell);
        if (!step || *step > kLastStep)
            return fail(column, fmt::format("found {}, expected a step, a whole number from 0; "
                                            "columns start_s and end_s take seconds",
                                            data::in_quotes(cell)));
        bound = static_cast<double>(*step);
        return std::nullopt;
    }

    data::CsvReader& cells_;
    const LabelColumns& columns_;
};

}  // namespace

std::string_view name_of(Outcome::Kind kind) {
    constexpr std::string_view kNames[] = {"", "unknown", "success", "failure"};
    return kNames[static_cast<std::size_t>(kind)];
}

diag::Result<LabelTable> parse_labels(std::unique_ptr<data::ByteSource> source) {
    data::CsvReader reader(std::move(source));
    const auto header = reader.next();
    if (!header) return data::of_trace(header.failure());
    if (!*header)
        return Failure{Code::malformed_labels,
                       "is empty, expected the columns episode, predicate, "
                       "start and end"};
    const auto columns = label_columns(reader);
    if (!columns) return columns.failure();
    LabelTable table;
    table.in_seconds = columns->in_seconds;
    const LabelRows rows(reader, *columns);
    for (;;) {
        const auto more = reader.next();
        if (!more) return data::of_trace(more.failure());
        if (!*more) return table;
        if (reader.empty()) continue;  // cleared in a spreadsheet
        auto row = rows.row();
        if (!row) return row.failure();
        table.rows.push_back(std::move(*row));
    }
}

}  // namespace etlc::episodes
