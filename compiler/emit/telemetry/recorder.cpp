// Prints the flight recorder: its type, its functions, and the recording of a step.
#include <fmt/ranges.h>

#include <algorithm>

#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using check::Index;

/// Returns the row of this step.
const char* row_of(const Context& context) {
    return context.on_demand ? "row" : "now.row_";
}

/// Returns the row nearest by a distance in an expression.
std::string nearest_row(const Context& context, Index predicate, Index distance) {
    const auto member = context.names.nearest.find({predicate, distance});
    if (member != context.names.nearest.end()) return member->second.member;
    return fmt::format("{}{}.nearest", context.names.distance_local.at(distance),
                       context.on_demand ? "()" : "");
}

std::string steps(std::uint32_t n) {
    return diag::counted(n, "step");
}

}  // namespace

std::string recorder_row(const Context& context) {
    return fmt::format("etlmon::RecorderRow<{}, {}, {}>", context.recorded.figures,
                       context.recorded.bools.size(), context.recorded.monitors);
}

void print_recorder_type(Printer& out, const Context& context) {
    if (!context.plan.recorder) return;
    const plan::Recorder& recorder = *context.plan.recorder;
    out.line();
    print_doc(out, fmt::format(
                       "Keeps {}, {} and {} of each step: {} before an alarm, {} after it, for {}.",
                       diag::counted(context.recorded.figures, "figure"),
                       diag::counted(context.recorded.bools.size(), "bool"),
                       diag::counted(context.recorded.monitors, "verdict"), steps(recorder.before),
                       steps(recorder.after), diag::counted(recorder.incidents, "incident")));
    print_wrapped(out, fmt::format("using Recorder = etlmon::Recorder<{}, {}, {}, {}>;",
                                   recorder_row(context), recorder.before, recorder.after,
                                   recorder.incidents));
}

void print_recorder_constants(Printer& out, const Context& context) {
    if (!context.plan.recorder) return;
    print_doc(out, "Incidents: XXH64 of their columns, and the greatest size of one in bytes.");
    out.line("static constexpr uint64_t kColumnsHash = 0x{:016x}u;",
             plan::columns_hash(context.plan));
    out.line("static constexpr size_t kIncidentBytes = {};", plan::incident_bytes(context.plan));
}

void print_recorder_interface(Printer& out, const Context& context) {
    if (!context.plan.recorder) return;
    const plan::Recorder& recorder = *context.plan.recorder;
    print_doc(out, fmt::format("Returns the number of complete incidents. An incident is an alarm "
                               "with the {} before it and the {} after it; it is complete {} after "
                               "its alarm, and does not change from then on.",
                               steps(recorder.before), steps(recorder.after),
                               steps(recorder.before + 1 + recorder.after)));
    out.line("uint32_t incidents() const noexcept { return recorder_.complete(); }");
    print_doc(out, "Returns the number of alarms for which there was no room; saturates.");
    out.line("uint32_t lost_incidents() const noexcept { return recorder_.lost(); }");
    print_doc(out, "Completes incidents that wait for steps, with the steps recorded so far.");
    out.line("void close_incidents() noexcept { recorder_.close(); }");
    print_doc(out, "Removes all complete incidents, to make room for new ones.");
    out.line("void forget_incidents() noexcept { recorder_.forget(); }");
    print_doc(out,
              "Writes incident n in the format of `etlc incident`, by calls of sink(const uint8_t* "
              "bytes, size_t size). Returns false if there is no such incident.");
    out.line("template <class Sink>");
    out.open("bool write_incident(uint32_t n, Sink&& sink) const {");
    print_wrapped(out,
                  "return recorder_.write(n, {kSpecHash, kDataHash, kThresholdsHash, "
                  "kColumnsHash}, sink);");
    out.close();
    out.line();
}

void print_recorded(Printer& out, const Context& context, Index predicate,
                    const std::string& delta) {
    if (!context.plan.recorder) return;
    const auto column =
        std::find_if(context.recorded.predicates.begin(), context.recorded.predicates.end(),
                     [&](const auto& of) { return of.predicate == predicate; });
    constexpr std::string_view kDelta = ".delta";
    const bool is_measured = context.model.predicates[predicate].plain_distance();
    if (is_measured && !column->nearest.empty()) {
        const std::string measured = delta.substr(0, delta.size() - kDelta.size());
        print_wrapped(out, fmt::format("{}.figures({}, {}, {}.nearest);", row_of(context),
                                       column->figure, delta, measured));
    } else {
        print_wrapped(out,
                      fmt::format("{}.figure({}, {});", row_of(context), column->figure, delta));
        for (std::size_t i = 0; i < column->nearest.size(); ++i)
            print_wrapped(
                out, fmt::format("{}.nearest({}, {});", row_of(context), column->figure + 1 + i,
                                 nearest_row(context, predicate, column->nearest[i])));
    }
    if (column->threshold)
        print_wrapped(out, fmt::format("{}.figure({}, threshold_{}());", row_of(context),
                                       column->figure + 1 + column->nearest.size(),
                                       context.model.predicates[predicate].name));
}

void print_recorded_flag(Printer& out, const Context& context, Index input,
                         const std::string& flag) {
    if (!context.plan.recorder) return;
    const std::vector<Index>& bools = context.recorded.bools;
    const auto at = std::find(bools.begin(), bools.end(), input) - bools.begin();
    print_wrapped(out, fmt::format("{}.flag({}, {});", row_of(context), at, flag));
}

void print_record(Printer& out, const Context& context, const std::string& verdicts) {
    if (!context.plan.recorder) return;
    std::vector<std::string> statuses;
    for (const plan::Monitor& monitor : context.plan.monitors)
        statuses.push_back(fmt::format("{}.{}.status", verdicts, monitor.name));
    print_wrapped(out,
                  fmt::format("const uint32_t statuses[] = {{{}}};", fmt::join(statuses, ", ")));
    out.line("recorder_.record({}, statuses);", row_of(context));
}

}  // namespace etlc::emit
