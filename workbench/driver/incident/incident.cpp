#include "driver/incident/incident.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/model/fingerprint.hpp"
#include "data/files/file.hpp"
#include "driver/incident/formats.hpp"
#include "driver/process/output_file.hpp"
#include "etlmon/temporal/recorder.hpp"
#include "plan/recorder_plan.hpp"

namespace etlc::driver {

namespace {

using data::Incident;

/// Whether the spec, as this call reads it, made the monitor that wrote the incident.
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

/// Whether the row is one that this monitor records, as far as its bytes tell.
bool is_recorded(const Incident::Row& row, std::size_t bools) {
    for (std::size_t i = 0; i < row.bytes.size(); ++i)
        if (row.bytes[i] >= (i < bools ? etlmon::kRecordedUnasked + 1 : 2 * etlmon::kAlarmBegins))
            return false;
    return true;
}

/// Whether the rows have what the columns say, and the alarm is one.
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
            {diag::Code::damaged_incident, "contradicts itself: its rows are none of this monitor"},
            path));
    return fits;
}

std::string text_of(const plan::Plan& plan, const Incident& incident, IncidentFormat format) {
    switch (format) {
        case IncidentFormat::table: return incident_table(plan, incident);
        case IncidentFormat::csv: return incident_csv(plan, incident);
        case IncidentFormat::trace: return incident_trace(plan, incident);
        case IncidentFormat::spec: return incident_spec(plan);
    }
    return "";
}

}  // namespace

bool incident(const source::File& spec, const Compiled& compiled, const IncidentRequest& request,
              diag::Sink& sink) {
    const plan::Plan& plan = compiled.plan;
    const auto bytes = data::read_file(request.file, data::kMaxIncidentBytes,
                                       diag::Code::unreadable_incident, data::Streams::taken);
    if (!bytes) return sink.report(data::in_file(bytes.failure(), request.file)), false;
    const auto read = data::within_memory([&] { return data::parse_incident(*bytes); });
    if (!read) return sink.report(data::in_file(read.failure(), request.file)), false;
    if (!check_origin(*read, plan, request.file, sink) ||
        !check_rows(*read, plan, request.file, sink))
        return false;
    std::vector<std::string> inputs = plan.model->dependencies;
    inputs.insert(inputs.end(), {spec.path(), request.file});
    if (!check_outputs({request.output}, inputs, sink)) return false;
    OutputFiles files(sink);
    return files.add(request.output, text_of(plan, *read, request.format)) && files.commit();
}

}  // namespace etlc::driver
