#include "driver/incident/formats.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "etlmon/temporal/recorder.hpp"
#include "plan/recorder_plan.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

namespace {

using check::Index;
using data::Incident;
using plan::RecorderColumns;
using Cells = std::vector<std::string>;
using Answers = etlmon::Answers<etlmon::Verdict>;

/// How what is not there is written.
struct Words {
    std::string missing;
    std::string unasked;
};
const Words kInTable{"missing", "unasked"}, kInCsv{"", "unasked"}, kInTrace{"", ""};

std::string figure(std::uint32_t bits, const Words& words) {
    if (bits == etlmon::kUnaskedBits) return words.unasked;
    if (bits == etlmon::detail::kMissingBits) return words.missing;
    return fmt::format("{:.9g}", std::bit_cast<float>(bits));
}

std::string flag(std::uint8_t byte, const Words& words) {
    if (byte == etlmon::kRecordedUnasked) return words.unasked;
    return byte == etlmon::kRecordedMissing ? words.missing : byte == 0 ? "0" : "1";
}

/// What a program does about it, where it is final.
std::string status(std::uint8_t byte) {
    const auto has = [byte](std::uint8_t bits) { return (byte & bits) == bits; };
    if (!has(Answers::kDecided)) return "undecided";
    const bool final = has(Answers::kFinal);
    if (has(Answers::kViolated)) return final ? "alarm" : "violated";
    if (has(Answers::kSatisfied)) return final ? "fulfilled" : "satisfied";
    return "unknown";
}

class Rows {
public:
    Rows(const plan::Plan& plan, const Incident& incident)
        : plan_(plan), model_(*plan.model), incident_(incident) {}

    const std::vector<Incident::Row>& all() const { return incident_.rows; }
    const Incident::Row& alarm() const { return incident_.rows[incident_.alarm]; }

    /// The names of monitors whose alarm begins at the row.
    Cells alarms(const Incident::Row& row) const {
        Cells names;
        for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
            if ((verdict(row, m) & etlmon::kAlarmBegins) != 0)
                names.push_back(plan_.monitors[m].name);
        return names;
    }

    std::string time(const Incident::Row& row) const {
        return fmt::format("{:.9g}", static_cast<double>(row.step) * model_.step_seconds);
    }

    Cells head(const std::string& distance, const std::string& nearest) const {
        Cells cells{"step"};
        if (has_time()) cells.push_back("time");
        for (const RecorderColumns::OfPredicate& column : columns_.predicates) {
            const std::string name = plan::column_name(model_, column.predicate);
            cells.push_back(distance + name);
            for (const Index d : column.nearest)
                cells.push_back(nearest_name(column, d, nearest, name));
            if (column.threshold) cells.push_back("threshold_" + name);
        }
        for (const Index i : columns_.bools) cells.push_back(model_.inputs[i].name);
        for (const plan::Monitor& monitor : plan_.monitors) cells.push_back(monitor.name);
        return cells;
    }

    Cells cells(const Incident::Row& row, const Words& words) const {
        Cells result{fmt::format("{}", row.step)};
        if (has_time()) result.push_back(time(row));
        for (const RecorderColumns::OfPredicate& column : columns_.predicates) {
            const std::uint32_t* at = row.figures.data() + column.figure;
            const bool known = *at != etlmon::kUnaskedBits && *at != etlmon::detail::kMissingBits;
            result.push_back(figure(*at++, words));
            for (std::size_t i = 0; i < column.nearest.size(); ++i, ++at)
                result.push_back(known ? fmt::format("{}", *at) : "");
            if (column.threshold) result.push_back(figure(*at, words));
        }
        for (std::size_t b = 0; b < columns_.bools.size(); ++b)
            result.push_back(flag(row.bytes[b], words));
        for (std::size_t m = 0; m < plan_.monitors.size(); ++m)
            result.push_back(status(verdict(row, m)));
        return result;
    }

    /// Distances and bools alone.
    Cells measured(const Incident::Row& row) const {
        Cells result;
        for (const RecorderColumns::OfPredicate& column : columns_.predicates)
            result.push_back(figure(row.figures[column.figure], kInTrace));
        for (std::size_t b = 0; b < columns_.bools.size(); ++b)
            result.push_back(flag(row.bytes[b], kInTrace));
        return result;
    }

    bool has_time() const { return model_.step_seconds > 0; }
    const RecorderColumns& columns() const { return columns_; }

private:
    /// "row", or "nearest_near"; of more than a distance with its target: "row of goal",
    /// "nearest_near_goal".
    std::string nearest_name(const RecorderColumns::OfPredicate& column, Index distance,
                             const std::string& prefix, const std::string& name) const {
        const std::string& target = model_.targets[model_.distances[distance].target].name;
        const bool plain = model_.predicates[column.predicate].plain_distance();
        if (prefix.empty()) return plain ? "row" : "row of " + target;
        return prefix + name + (plain ? "" : "_" + target);
    }

    std::uint8_t verdict(const Incident::Row& row, std::size_t monitor) const {
        return row.bytes[columns_.bools.size() + monitor];
    }

    const plan::Plan& plan_;
    const check::Model& model_;
    const Incident& incident_;
    RecorderColumns columns_ = plan::recorder_columns(plan_);
};

std::string csv_line(Cells cells) {
    for (std::string& cell : cells) cell = source::csv_cell(cell);
    return fmt::format("{}\n", fmt::join(cells, ","));
}

/// The columns to the right, each as wide as its widest cell; `mark` stands before a line.
std::string aligned(const std::vector<Cells>& lines, std::size_t marked) {
    std::vector<std::size_t> widths(lines.front().size(), 0);
    for (const Cells& cells : lines)
        for (std::size_t c = 0; c < cells.size(); ++c)
            widths[c] = std::max(widths[c], cells[c].size());
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        text += i == marked ? "*" : " ";
        for (std::size_t c = 0; c < widths.size(); ++c)
            text += fmt::format(" {:>{}}", lines[i][c], widths[c]);
        text += "\n";
    }
    return text;
}

/// What the trace calls a predicate.
std::string input_of(const check::Model& model, Index p, std::size_t number) {
    const std::string& name = model.predicates[p].name;
    return name.empty() ? fmt::format("comparison_{}", number) : "distance_" + name;
}

/// " in [0, inf]": what bounds over every continuation rest on.
std::string range_of(const check::Predicate& predicate) {
    const auto [low, high] = predicate.delta;
    if (std::isinf(low) && std::isinf(high)) return "";
    return fmt::format(" in [{}, {}]", low, high);
}

/// "distance_near <= 0.35", and what the spec says behind the threshold.
std::string comparison(const check::Model& model, const check::Predicate& predicate,
                       const std::string& input) {
    const std::string_view text = predicate.text;  // "min l2(z, goal) <= "
    const std::size_t end = text.find_last_not_of(' ') + 1;
    const std::string_view sign = text.substr(0, end).substr(text.rfind(' ', end - 1) + 1);
    const std::uint32_t behind = predicate.threshold.span.end;
    const bool is_written = behind > predicate.span.begin;
    return fmt::format("{} {} {}{}", input, sign, predicate.threshold.value,
                       is_written ? model.file.text(source::Span{behind, predicate.span.end}) : "");
}

/// What stands at a place of the spec instead.
using Changes = std::map<std::uint32_t, std::pair<source::Span, std::string>>;

/// A comparison without a name may stand in several formulas.
void change_everywhere(Changes& changes, const check::Model& model, Index p,
                       const std::string& text) {
    const check::Predicate& predicate = model.predicates[p];
    if (!predicate.name.empty()) {
        changes[predicate.span.begin] = {predicate.span,
                                         "predicate " + predicate.name + " = " + text};
        return;
    }
    for (const check::Formula& formula : model.formulas)
        if (formula.kind == check::Formula::Kind::predicate && formula.index == p)
            changes[formula.span.begin] = {formula.span, text};
}

}  // namespace

std::string incident_table(const plan::Plan& plan, const Incident& incident) {
    const Rows rows(plan, incident);
    const check::Model& model = *plan.model;
    std::string text = fmt::format("incident {} of {}, episode {}: alarm of {} at step {}{}\n",
                                   incident.number, model.name, incident.episode,
                                   fmt::join(rows.alarms(rows.alarm()), ", "), rows.alarm().step,
                                   rows.has_time() ? " (" + rows.time(rows.alarm()) + " s)" : "");
    if (incident.lost > 0)
        text += fmt::format("{} more found no room\n", diag::counted(incident.lost, "alarm"));
    for (const RecorderColumns::OfPredicate& column : rows.columns().predicates) {
        const check::Predicate& predicate = model.predicates[column.predicate];
        text += fmt::format("{}: {}{}\n", plan::column_name(model, column.predicate),
                            predicate.text, predicate.threshold.value);
    }
    std::vector<Cells> lines{rows.head("", "")};
    for (const Incident::Row& row : rows.all()) lines.push_back(rows.cells(row, kInTable));
    return source::visible_lines(text + "\n" + aligned(lines, incident.alarm + 1));
}

std::string incident_csv(const plan::Plan& plan, const Incident& incident) {
    const Rows rows(plan, incident);
    const auto with = [](Cells cells, std::string last) {
        cells.push_back(std::move(last));
        return csv_line(std::move(cells));
    };
    std::string text = with(rows.head("distance_", "nearest_"), "alarm");
    for (const Incident::Row& row : rows.all())
        text += with(rows.cells(row, kInCsv), fmt::format("{}", fmt::join(rows.alarms(row), " ")));
    return text;
}

std::string incident_trace(const plan::Plan& plan, const Incident& incident) {
    const Rows rows(plan, incident);
    Cells names;
    for (const RecorderColumns::OfPredicate& column : rows.columns().predicates)
        names.push_back(input_of(*plan.model, column.predicate, names.size() + 1));
    for (const Index i : rows.columns().bools) names.push_back(plan.model->inputs[i].name);
    std::string text = csv_line(std::move(names));
    for (const Incident::Row& row : rows.all()) text += csv_line(rows.measured(row));
    return text;
}

std::string incident_spec(const plan::Plan& plan) {
    const check::Model& model = *plan.model;
    Changes changes;
    std::string inputs;
    std::size_t number = 0;
    for (const Index p : plan.predicates) {
        const check::Predicate& predicate = model.predicates[p];
        const std::string input = input_of(model, p, ++number);
        inputs += fmt::format("input {} : f32{};\n", input, range_of(predicate));
        change_everywhere(changes, model, p, comparison(model, predicate, input));
    }
    for (const plan::Monitor& monitor : plan.monitors)
        if (monitor.shifted) {
            const source::Span clause = model.monitors[monitor.index].calibration->threshold.span;
            changes[clause.begin] = {
                clause, fmt::format("/* calibrated as a whole: less by {} */", monitor.shift)};
        }
    std::string text;
    std::uint32_t copied = 0;
    const auto end = static_cast<std::uint32_t>(model.file.text().size());
    for (const auto& [begin, change] : changes) {
        text += model.file.text({copied, begin});
        text += change.second;
        copied = change.first.end;
    }
    text += model.file.text({copied, end});
    return text + (text.ends_with("\n") ? "" : "\n") + inputs;
}

}  // namespace etlc::driver
