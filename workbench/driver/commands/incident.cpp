#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>

#include "check/guarantees/guarantees.hpp"
#include "check/model/fingerprint.hpp"
#include "data/files/file.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "etlmon/temporal/recorder.hpp"
#include "plan/plan.hpp"
#include "plan/recorder_plan.hpp"
#include "recordings/incident.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

using recordings::Incident;

using check::Index;
using plan::RecorderColumns;
using Cells = std::vector<std::string>;
using Answers = etlmon::Answers<etlmon::Verdict>;

/// The words for values that were not recorded.
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

/// Names a verdict; a final one as a program reacts to it.
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

    /// Returns the names of the monitors whose alarm begins at the row.
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

    /// Returns the distances and bools alone.
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
    /// Returns "row" or "nearest_near"; with the target, "row of goal" or "nearest_near_goal",
    /// where a predicate is more than a distance.
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

/// Aligns columns to the right, each as wide as its widest cell; a mark precedes one line.
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

/// Prints an incident for people: its origin, the comparisons, and a line a step.
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
                            predicate.text, check::numbers(predicate.threshold));
    }
    std::vector<Cells> lines{rows.head("", "")};
    for (const Incident::Row& row : rows.all()) lines.push_back(rows.cells(row, kInTable));
    return source::visible_lines(text + "\n" + aligned(lines, incident.alarm + 1));
}

/// Prints an incident as CSV: a row a step, with all that was recorded.
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

/// Prints the measurements as a trace: a column `distance_P` for each predicate, and the bools.
std::string incident_trace(const plan::Plan& plan, const Incident& incident) {
    const Rows rows(plan, incident);
    Cells names;
    for (const RecorderColumns::OfPredicate& column : rows.columns().predicates)
        names.push_back(measured_name(*plan.model, column.predicate, names.size() + 1));
    for (const Index i : rows.columns().bools) names.push_back(plan.model->inputs[i].name);
    std::string text = csv_line(std::move(names));
    for (const Incident::Row& row : rows.all()) text += csv_line(rows.measured(row));
    return text;
}

/// Reports an incident whose monitor was made from another spec, data or thresholds.
bool check_origin(const Incident& incident, const plan::Plan& plan, const std::string& path,
                  diag::Sink& sink) {
    const check::Fingerprint own = check::fingerprint(*plan.model);
    const auto differs = [&](const char* what, std::uint64_t found, std::uint64_t expected,
                             const char* advice) {
        if (found == expected) return false;
        sink.report(
                data::in_file({diag::Code::incident_of_another,
                               fmt::format("the monitor that wrote it was made from {} with XXH64 "
                                           "{:016x}; {:016x} was expected",
                                           what, found, expected)},
                              path))
            .note(advice);
        return true;
    };
    return !differs(
               "a spec", incident.spec, own.spec,
               "give the spec as it was then: the head of the generated header has its XXH64") &&
           !differs("target sets and weights", incident.data, own.data,
                    "give the files of targets and weights as they were then") &&
           !differs("thresholds", incident.thresholds, own.thresholds,
                    "give the thresholds of then with --thresholds") &&
           !differs("columns", incident.columns, plan::columns_hash(plan),
                    "give the options that the header was made with");
}

/// Returns whether the bytes of a row can be of this monitor.
bool is_recorded(const Incident::Row& row, std::size_t bools) {
    for (std::size_t i = 0; i < row.bytes.size(); ++i)
        if (row.bytes[i] >= (i < bools ? etlmon::kRecordedUnasked + 1 : 2 * etlmon::kAlarmBegins))
            return false;
    return true;
}

/// Reports rows that do not fit the columns, and an alarm that is none.
bool check_rows(const Incident& incident, const plan::Plan& plan, const std::string& path,
                diag::Sink& sink) {
    const plan::RecorderColumns columns = plan::recorder_columns(plan);
    const std::size_t bools = columns.bools.size();
    const Incident::Row& alarm = incident.rows[incident.alarm];
    const bool fits =
        alarm.figures.size() == columns.figures && alarm.bytes.size() == bools + columns.monitors &&
        std::all_of(incident.rows.begin(), incident.rows.end(),
                    [bools](const Incident::Row& row) { return is_recorded(row, bools); }) &&
        std::any_of(alarm.bytes.begin() + static_cast<std::ptrdiff_t>(bools), alarm.bytes.end(),
                    [](std::uint8_t status) { return status >= etlmon::kAlarmBegins; });
    if (!fits)
        sink.report(data::in_file(
            {diag::Code::damaged_incident, "contradicts itself: its rows do not fit this monitor"},
            path));
    return fits;
}

std::string text_of(const plan::Plan& plan, const Incident& incident, IncidentFormat format) {
    switch (format) {
        case IncidentFormat::table: return incident_table(plan, incident);
        case IncidentFormat::csv: return incident_csv(plan, incident);
        case IncidentFormat::trace: return incident_trace(plan, incident);
        case IncidentFormat::spec: return measured_spec(plan);
    }
    return "";
}

}  // namespace

bool incident(const source::File& spec, const Compiled& compiled, const Request& request,
              diag::Sink& sink) {
    const plan::Plan& plan = compiled.plan;
    const std::string& path = request.incident.file;
    const auto bytes = data::read_file(path, recordings::kMaxIncidentBytes,
                                       diag::Code::unreadable_incident, data::Streams::taken);
    if (!bytes) return sink.report(data::in_file(bytes.failure(), path)), false;
    const auto read = data::within_memory([&] { return recordings::parse_incident(*bytes); });
    if (!read) return sink.report(data::in_file(read.failure(), path)), false;
    if (!check_origin(*read, plan, path, sink) || !check_rows(*read, plan, path, sink))
        return false;
    if (!check_outputs({request.output}, files_read(*plan.model, spec, {path}), sink)) return false;
    OutputFiles files(sink);
    return files.add(request.output, text_of(plan, *read, request.incident.format)) &&
           files.commit();
}

}  // namespace etlc::driver
