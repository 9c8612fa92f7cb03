#include "plan/recorder_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/files/hash.hpp"
#include "etlmon/temporal/recorder.hpp"
#include "plan/budget/budget.hpp"

namespace etlc::plan {

namespace {

/// Estimated code of a step and of writing an incident.
constexpr std::uint64_t kCode = 2500;

/// More than any state can hold.
constexpr double kMostSteps = 1e9;

/// Converts a length to steps, rounded up; a whole number of steps stays whole in spite of rounding
/// in double.
std::optional<std::uint32_t> steps_of(const Length& length, const check::Model& model,
                                      diag::Sink& sink) {
    double steps = length.number;
    if (length.in_seconds) {
        if (model.step_seconds == 0) {
            sink.report(diag::Code::recorder_without_rate, model.monitors.front().span,
                        fmt::format("--recorder says {}, but the spec has no rate or period to "
                                    "define the length of a step",
                                    length.text))
                .note(
                    "add a line such as 'rate 20 Hz;', or say how many steps: --recorder 40,20,4");
            return std::nullopt;
        }
        steps = std::ceil(steps / model.step_seconds * (1 - 1e-12));
    }
    return static_cast<std::uint32_t>(std::min(steps, kMostSteps));
}

/// Returns the text that is hashed, a line per column.
std::string columns_text(const Plan& plan) {
    const check::Model& model = *plan.model;
    const RecorderColumns columns = recorder_columns(plan);
    std::string text;
    for (const RecorderColumns::OfPredicate& column : columns.predicates) {
        text += "predicate";
        for (std::size_t i = 0; i < column.nearest.size(); ++i) text += " nearest";
        text += fmt::format("{} {}\n", column.threshold ? " threshold" : "",
                            column_name(model, column.predicate));
    }
    for (const Index i : columns.bools) text += "bool " + model.inputs[i].name + "\n";
    for (const Monitor& monitor : plan.monitors) text += "monitor " + monitor.name + "\n";
    return text;
}

void warn_of_late_monitors(const Plan& plan, diag::Sink& sink) {
    for (const Monitor& monitor : plan.monitors) {
        if (monitor.horizon <= plan.recorder->before) continue;
        sink.report(diag::Code::recorder_too_short, plan.model->monitors[monitor.index].span,
                    fmt::format("an alarm of '{}' is about the step {} before it; the recorder "
                                "keeps {}",
                                monitor.name, diag::counted(monitor.horizon, "step"),
                                plan.recorder->before))
            .note("a larger BEFORE of --recorder holds that step too");
    }
}

}  // namespace

std::uint64_t RecorderColumns::row_bytes() const {
    constexpr std::uint64_t kWord = 4;
    const std::uint64_t bytes = bools.size() + monitors;
    return kWord * (1 + figures) + (bytes + kWord - 1) / kWord * kWord;
}

std::string column_name(const check::Model& model, Index predicate) {
    const check::Predicate& p = model.predicates[predicate];
    return p.name.empty() ? check::print(model, p.expression) : p.name;
}

RecorderColumns recorder_columns(const Plan& plan) {
    const check::Model& model = *plan.model;
    RecorderColumns columns;
    for (const Index p : plan.predicates) {
        const check::Predicate& predicate = model.predicates[p];
        const RecorderColumns::OfPredicate column{p, columns.figures,
                                                  check::measured_targets(model, predicate),
                                                  predicate.threshold.adaptation.has_value()};
        columns.predicates.push_back(column);
        columns.figures +=
            static_cast<std::uint32_t>(1 + column.nearest.size()) + (column.threshold ? 1U : 0U);
    }
    for (const Index i : plan.inputs)
        if (model.inputs[i].type == check::InputType::boolean) columns.bools.push_back(i);
    columns.monitors = static_cast<std::uint32_t>(plan.monitors.size());
    return columns;
}

std::uint64_t columns_hash(const Plan& plan) {
    return data::xxh64(columns_text(plan));
}

std::uint64_t recorder_bytes(const Plan& plan) {
    constexpr std::uint64_t kWord = 4, kCounters = 8, kWordsPerIncident = 4;
    const RecorderColumns columns = recorder_columns(plan);
    const std::uint64_t ring = 1 + std::uint64_t{plan.recorder->before};
    const std::uint64_t incidents = plan.recorder->incidents;
    return kWord * (kCounters + (columns.monitors + 31) / 32 + kWordsPerIncident * incidents) +
           columns.row_bytes() * (ring + incidents * (ring + plan.recorder->after));
}

std::uint64_t incident_bytes(const Plan& plan) {
    const std::uint64_t rows = std::uint64_t{plan.recorder->before} + 1 + plan.recorder->after;
    const std::uint64_t bytes =
        etlmon::kIncidentHeadBytes + rows * recorder_columns(plan).row_bytes();
    return (bytes + 31) / 32 * 32 + etlmon::kIncidentChecksumBytes;
}

void add_recorder(Plan& plan, const RecorderRequest& request, const Limits& limits,
                  diag::Sink& sink) {
    const auto before = steps_of(request.before, *plan.model, sink);
    if (!before) return;
    const auto after = steps_of(request.after, *plan.model, sink);
    if (!after) return;
    plan.recorder = Recorder{*before, *after, request.incidents};
    const std::uint64_t bytes = recorder_bytes(plan);
    const std::uint64_t others = plan.cost.state_bytes + plan.cost.stack_bytes;
    plan.cost.state_bytes += bytes;
    plan.cost.code_bytes += kCode;
    warn_of_late_monitors(plan, sink);
    if (within(plan.cost, limits)) return;
    sink.report(diag::Code::over_budget, plan.model->monitors.front().span,
                fmt::format(
                    "a recorder of {} incidents of {} steps takes {} bytes, {} a step; with the "
                    "{} of the monitors that is more than the limit of {} bytes",
                    request.incidents, std::uint64_t{*before} + 1 + *after, bytes,
                    recorder_columns(plan).row_bytes(), others, limits.state_bytes))
        .note("fewer steps or fewer incidents take less; --max-state moves the limit");
}

}  // namespace etlc::plan
