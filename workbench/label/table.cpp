#include "label/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <utility>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"

namespace etlc::label {

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;
using episodes::Label;

constexpr std::uint64_t kMostTableBytes = 1U << 30U;
constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Returns the bytes of a file; nothing where there is none.
diag::Result<std::optional<std::string>> bytes_of(const std::string& path) {
    std::error_code error;
    if (!fs::exists(path, error) && !error) return std::optional<std::string>();
    auto bytes = data::read_file(path, kMostTableBytes, Code::unreadable_trace);
    if (!bytes) return bytes.failure();
    return std::optional(std::move(*bytes));
}

/// Encloses a cell in quotes where RFC 4180, or blanks around it, require that.
std::string cell(const std::string& text) {
    const bool is_plain = text.find_first_of(",\"\r\n") == std::string::npos &&
                          (text.empty() || (text.find_first_of(" \t") != 0 &&
                                            text.find_last_of(" \t") != text.size() - 1));
    if (is_plain) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string marked(const episodes::LabelRow& row) {
    return row.label == Label::unknown ? "?" + row.predicate
           : row.label == Label::no    ? "!" + row.predicate
                                       : row.predicate;
}

bool is_same(const episodes::LabelRow& a, const episodes::LabelRow& b) {
    return a.episode == b.episode && a.predicate == b.predicate && a.label == b.label &&
           a.start == b.start && a.end == b.end && a.group == b.group && a.outcome == b.outcome;
}

}  // namespace

diag::Result<Table> Table::read(std::string path, const std::vector<std::string>& episodes,
                                double step_seconds) {
    Table table;
    table.path_ = std::move(path);
    table.step_seconds_ = step_seconds;
    auto bytes = bytes_of(table.path_);
    if (!bytes) return bytes.failure();
    table.bytes_ = std::move(*bytes);
    if (!table.bytes_) return table;
    const auto parsed = data::within_memory(
        [&] { return episodes::parse_labels(data::from_memory(*table.bytes_)); });
    if (!parsed) return parsed.failure();
    table.in_seconds_ = parsed->in_seconds;
    if (table.in_seconds_ && step_seconds <= 0)
        return Failure{Code::steps_without_time,
                       "labels in seconds, but the spec has no rate: declare one, such as 'rate 10 "
                       "Hz;', or label steps, in the columns start and end"};
    const auto normal = [](const std::string& name) {
        return fs::path(name).lexically_normal().string();
    };
    episodes::Named names;
    for (const episodes::LabelRow& row : parsed->rows) names[normal(row.episode)];
    episodes::find_named(episodes, names);
    for (const episodes::LabelRow& row : parsed->rows) {
        const std::vector<std::size_t>& found = names.at(normal(row.episode));
        table.rows_.push_back({row, found.size() == 1 ? episodes[found[0]] : ""});
    }
    return table;
}

bool Table::has_changed() const {
    const auto now = bytes_of(path_);
    return !now || *now != bytes_;
}

std::optional<Failure> Table::write(const std::vector<LabelsOf>& labels) {
    Rows rows = rows_;
    for (const LabelsOf& one : labels) put(one, rows);
    std::string text = text_of(rows);
    // A name that a table cannot hold, such as one that is no UTF-8, is noticed before the file is.
    const auto parsed = episodes::parse_labels(data::from_memory(text));
    if (!parsed) return parsed.failure();
    if (!std::equal(rows.begin(), rows.end(), parsed->rows.begin(), parsed->rows.end(), is_same))
        return Failure{Code::malformed_labels, "cannot hold the name of this episode"};
    const auto is_right = [&]() -> std::optional<Failure> {
        if (!has_changed()) return std::nullopt;
        return Failure{Code::unwritable_output,
                       "was changed by another program, and is not overwritten"};
    };
    if (auto failure = data::write_file_durably(path_, text, Code::unwritable_output, is_right))
        return failure;
    rows_ = std::move(rows);
    bytes_ = std::move(text);
    return std::nullopt;
}

/// Replaces the rows of a predicate in an episode where the first of them is, or after the others.
void Table::put(const LabelsOf& labels, Rows& rows) const {
    const auto is_replaced = [&](const Row& row) {
        return row.of == labels.episode && row.predicate == labels.predicate;
    };
    const auto first = std::find_if(rows.begin(), rows.end(), is_replaced);
    const auto place = first - rows.begin();
    const bool is_known = first != rows.end();
    Row row;
    row.of = labels.episode;
    row.episode = is_known ? first->episode : labels.name;
    row.predicate = labels.predicate;
    for (const Row& other : rows_)
        if (other.of == labels.episode && row.group.empty()) row.group = other.group;
    Rows added;
    if (labels.marks && labels.marks->empty()) {
        row.label = Label::no;
        added.push_back(row);
    }
    const auto time_of = [&](std::uint64_t step) {
        constexpr double kParts = 1e9;  // of a second, so that 3 * 0.1 is written 0.3
        if (!in_seconds_) return static_cast<double>(step);
        return std::round(static_cast<double>(step) * step_seconds_ * kParts) / kParts;
    };
    for (const Interval& interval : joined(labels.marks.value_or(std::vector<Interval>()))) {
        row.label = interval.label;
        row.start = time_of(interval.start);
        row.end = interval.end == labels.steps ? kEndless : time_of(interval.end);
        added.push_back(row);
    }
    std::erase_if(rows, is_replaced);
    if (added.empty() && !row.group.empty()) {  // the group stays, if no other row has it
        row.predicate.clear();
        row.label = Label::yes;
        const bool is_kept = std::any_of(rows.begin(), rows.end(), [&](const Row& other) {
            return other.of == row.of && !other.group.empty();
        });
        if (!is_kept) added.push_back(row);
    }
    rows.insert(rows.begin() + place, added.begin(), added.end());
}

std::string Table::bound(double value) const {
    if (std::isinf(value)) return "";
    return in_seconds_ ? fmt::format("{}", value) : fmt::format("{:.0f}", value);
}

std::string Table::text_of(const Rows& rows) const {
    const bool has_groups =
        std::any_of(rows.begin(), rows.end(), [](const Row& row) { return !row.group.empty(); });
    const bool has_outcomes = std::any_of(rows.begin(), rows.end(), [](const Row& row) {
        return row.outcome != episodes::Outcome::Kind::none;
    });
    std::string text =
        in_seconds_ ? "episode,predicate,start_s,end_s" : "episode,predicate,start,end";
    text += fmt::format("{}{}\n", has_groups ? ",group" : "", has_outcomes ? ",outcome" : "");
    for (const Row& row : rows) {
        const bool is_whole = row.start == 0 && std::isinf(row.end);
        text += fmt::format("{},{},{},{}", cell(row.episode), cell(marked(row)),
                            is_whole ? "" : bound(row.start), bound(row.end));
        if (has_groups) text += "," + cell(row.group);
        if (has_outcomes) text += fmt::format(",{}", name_of(row.outcome));
        text += "\n";
    }
    return text;
}

namespace {

using Intervals = std::vector<Interval>;

/// Returns the first interval that ends after the step: the one at it, or the next one.
Intervals::iterator at_or_after(Intervals& intervals, std::uint64_t step) {
    return std::find_if(intervals.begin(), intervals.end(),
                        [&](const Interval& one) { return one.end > step; });
}

/// Moves the beginning of the interval at this step. Without one, a new interval lasts up to the
/// next, so that no later mark is lost.
void begin_at(Intervals& intervals, std::uint64_t step, std::uint64_t steps) {
    const auto found = at_or_after(intervals, step);
    if (found != intervals.end() && found->start <= step)
        found->start = step;
    else
        intervals.insert(found, {step, found == intervals.end() ? steps : found->start});
}

/// Moves the end of the interval at this step, or of the last one before it. Without one, it held
/// from the beginning on.
void end_at(Intervals& intervals, std::uint64_t step) {
    const auto found = at_or_after(intervals, step);
    if (found != intervals.end() && found->start <= step)
        found->end = step + 1;
    else if (found != intervals.begin())
        std::prev(found)->end = step + 1;
    else
        intervals.insert(found, {0, step + 1});
}

}  // namespace

std::optional<Key> key_named(std::string_view word) {
    constexpr std::string_view kWords[] = {"begin", "end", "unknown", "remove", "never", "forget"};
    const auto* const found = std::find(std::begin(kWords), std::end(kWords), word);
    if (found == std::end(kWords)) return std::nullopt;
    return static_cast<Key>(found - std::begin(kWords));
}

std::vector<Interval> joined(const std::vector<Interval>& intervals) {
    Intervals result;
    for (const Interval& one : intervals) {
        if (!result.empty() && result.back().end == one.start && result.back().label == one.label)
            result.back().end = one.end;
        else
            result.push_back(one);
    }
    return result;
}

Marks after_key(const Marks& before, Key key, std::uint64_t step, std::uint64_t steps) {
    if (key == Key::forget) return std::nullopt;
    if (key == Key::never) return Intervals();
    Intervals intervals = before.value_or(Intervals());
    if (key == Key::end) {
        end_at(intervals, step);
        return joined(intervals);
    }
    intervals = joined(intervals);
    if (key == Key::begin) {
        begin_at(intervals, step, steps);
        return intervals;
    }
    const auto found = at_or_after(intervals, step);
    if (found == intervals.end() || found->start > step) return before;
    if (key == Key::unknown)
        found->label = found->label == Label::yes ? Label::unknown : Label::yes;
    else
        intervals.erase(found);
    return intervals;
}

}  // namespace etlc::label
