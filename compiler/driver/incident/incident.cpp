#include "driver/incident/incident.hpp"

#include <fmt/format.h>

#include "check/model/fingerprint.hpp"
#include "data/files/file.hpp"
#include "driver/incident/formats.hpp"
#include "driver/output_file.hpp"
#include "plan/recorder.hpp"

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

/// Whether each row has what the columns say, and nothing that no monitor records.
bool check_shape(const Incident& incident, const plan::Plan& plan, const std::string& path,
                 diag::Sink& sink) {
    const plan::RecorderColumns columns = plan::recorder_columns(plan);
    const Incident::Row& row = incident.rows.front();
    if (row.figures.size() == columns.figures &&
        row.bytes.size() == columns.bools.size() + columns.monitors)
        return true;
    sink.report(data::in_file(
        {diag::Code::damaged_incident,
         fmt::format("contradicts itself: a row of {} figures and {} bytes, expected {} and {}",
                     row.figures.size(), row.bytes.size(), columns.figures,
                     columns.bools.size() + columns.monitors)},
        path));
    return false;
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
    const auto bytes =
        data::read_file(request.file, data::kMaxIncidentBytes, diag::Code::unreadable_incident);
    if (!bytes) return sink.report(data::in_file(bytes.failure(), request.file)), false;
    const auto read = data::within_memory([&] { return data::parse_incident(*bytes); });
    if (!read) return sink.report(data::in_file(read.failure(), request.file)), false;
    if (!check_origin(*read, plan, request.file, sink) ||
        !check_shape(*read, plan, request.file, sink))
        return false;
    std::vector<std::string> inputs = plan.model->dependencies;
    inputs.insert(inputs.end(), {spec.path(), request.file});
    if (!check_outputs({request.output}, inputs, sink)) return false;
    OutputFiles files(sink);
    return files.add(request.output, text_of(plan, *read, request.format)) && files.commit();
}

}  // namespace etlc::driver
