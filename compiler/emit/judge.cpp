// Prints judge(): from the robustness of every predicate at this step to the verdicts.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

/// Returns the value, shifted with its bounds if the monitor was calibrated as a whole.
std::string shifted(const plan::Monitor& monitor, const std::string& value) {
    return monitor.shifted
               ? fmt::format("etlmon::shifted({}, {})", value, float_literal(monitor.shift))
               : value;
}

/// Returns the reading or value without its sample.
std::string robustness(const Context& context, const std::string& value) {
    return context.explains ? fmt::format("etlmon::unsourced({})", value) : value;
}

/// Returns the verdict from values that carry their sample, and keeps the one that decides it.
std::string deciding(const plan::Monitor& monitor, std::string_view kind, std::size_t m,
                     const std::string& value) {
    return fmt::format("deciding_.{}({}, {}{})", kind, m, value,
                       monitor.shifted ? ", " + float_literal(monitor.shift) : "");
}

bool is_deciding(const Context& context) {
    return context.explains && !context.sampled.places.empty();
}

std::string prefix_verdict(const Context& context, std::size_t m) {
    const plan::Monitor& monitor = context.plan.monitors[m];
    const std::string& reading = context.names.readings[monitor.reading].local;
    if (is_deciding(context)) return deciding(monitor, "prefix", m, reading);
    return fmt::format("etlmon::prefix_verdict({})",
                       shifted(monitor, robustness(context, reading)));
}

/// Returns the verdict on the position one horizon ago, if the trace contains it.
std::string sliding_verdict(const Context& context, std::size_t m) {
    const plan::Monitor& monitor = context.plan.monitors[m];
    const std::string value = context.value(monitor.stream);
    const std::string exists = fmt::format("exists({}) ? ", monitor.horizon);
    if (is_deciding(context))
        return fmt::format("{}{} : deciding_.undecided({})", exists,
                           deciding(monitor, "sliding", m, value), m);
    return fmt::format("{}etlmon::sliding_verdict({}) : {}()", exists,
                       shifted(monitor, robustness(context, value)), context.spelling.verdict);
}

std::string verdict(const Context& context, std::size_t m) {
    const plan::Monitor& monitor = context.plan.monitors[m];
    if (monitor.sliding) return sliding_verdict(context, m);
    if (context.plan.has_sliding) return context.names.verdict_member.at(m);
    return prefix_verdict(context, m);
}

/// Prints a reading of a Boolean monitor, which is computed while some verdict can still change.
void print_reading_while_open(Printer& out, const Context& context, std::uint32_t r) {
    const plan::Reading& reading = context.plan.readings[r];
    const std::string open = open_monitors(context, context.dependents.of_reading[r]);
    if (!reading.operands.empty() || open.empty())
        return print_reading(out, context, r);  // a combination of readings, or always open
    out.line("Reading {}{{}};", context.names.readings[r].local);
    print_wrapped(out, fmt::format("if ({}) {{", open));
    out.indent();
    print_reading(out, context, r);
    out.close();
}

void print_readings(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    if (plan.readings.empty()) return;
    const bool ends =
        plan.has_sliding && !context.on_demand;  // the prefix does not grow during finish()
    if (ends) {
        out.gap();
        out.open("if (finishes_ == 0) {");
    }
    for (std::uint32_t r = 0; r < plan.readings.size(); ++r) {
        out.gap();
        print_comment(out, "//", context.place(plan.readings[r].node), 4);
        context.on_demand ? print_reading_while_open(out, context, r)
                          : print_reading(out, context, r);
    }
    if (!ends) return;
    for (const auto& [m, name] : context.names.verdict_member)
        print_wrapped(out, fmt::format("{} = {};", name, prefix_verdict(context, m)));
    out.close();
}

std::string if_open(const Context& context, std::size_t m) {
    const auto open = context.names.open_local.find(m);
    return open == context.names.open_local.end() ? "" : fmt::format("if ({}) ", open->second);
}

/// Prints the update of the verdicts that can still change.
void print_open_verdicts(Printer& out, const Context& context) {
    for (std::size_t m = 0; m < context.plan.monitors.size(); ++m) {
        const plan::Monitor& monitor = context.plan.monitors[m];
        if (monitor.sliding)
            print_wrapped(
                out, fmt::format("answers_.{} = {};", monitor.name, sliding_verdict(context, m)));
        else
            print_wrapped(
                out, fmt::format("{}answers_.{} = etlmon::prefix_verdict({});", if_open(context, m),
                                 monitor.name, context.names.readings[monitor.reading].local));
    }
}

}  // namespace

void open_half(Printer& out, const Context& context, std::string_view result,
               std::string_view function) {
    const std::string_view qualifier = context.step_qualifier();
    out.open(fmt::format("{}{} Monitor::{} noexcept {{", qualifier.empty() ? "inline " : qualifier,
                         result, function));
}

void print_advance(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    open_half(
        out, context, "Verdicts",
        fmt::format("advance({}const Inputs& in)", plan.inputs.empty() ? "[[maybe_unused]] " : ""));
    out.line("using etlmon::max_of;");
    out.line("using etlmon::min_of;");
    out.line("bool missing = false;");
    if (plan.recorder) out.line("{} row;", recorder_row(context));
    print_atoms_on_demand(out, context);
    out.gap();
    for (const auto& [m, open] : context.names.open_local) {
        const bool repeats = plan.monitors[m].restarts == check::Restarts::when_final;
        const std::string undecided =
            repeats ? "" : fmt::format("!answers_.{}.final()", plan.monitors[m].name);
        print_wrapped(out, fmt::format("const bool {} = {}{}{};", open,
                                       plan.has_sliding ? "finishes_ == 0" : "",
                                       plan.has_sliding && !repeats ? " && " : "", undecided));
    }
    out.gap();
    print_streams(out, context);
    print_readings(out, context);
    out.gap();
    print_open_verdicts(out, context);
    print_lets(out, context);
    print_kept_points(out, context);
    print_wrapped(out, "if (missing && incomplete_ != UINT32_MAX) ++incomplete_;");
    print_progress(out, context, "answers_");
    print_record(out, context, "answers_");
    if (plan.counts_steps) print_wrapped(out, counted("position_"));
    out.line("return answers_;");
    out.close();
}

void print_judge(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    const bool reads_atoms =
        !context.names.predicate_atom.empty() || !context.names.flag_atom.empty() || plan.recorder;
    open_half(out, context, "Verdicts",
              fmt::format("judge({}const Atoms& now)", reads_atoms ? "" : "[[maybe_unused]] "));
    out.line("using etlmon::max_of;");
    out.line("using etlmon::min_of;");
    out.gap();
    print_streams(out, context);
    print_readings(out, context);
    out.gap();
    out.line("Verdicts verdicts;");
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) {
        const std::string answer = "verdicts." + plan.monitors[m].name;
        print_wrapped(out, fmt::format("{} = {};", answer, verdict(context, m)));
    }
    print_lets(out, context);
    print_progress(out, context, "verdicts");
    print_record(out, context, "verdicts");
    if (plan.counts_steps) print_wrapped(out, counted("position_"));
    out.line("return verdicts;");
    out.close();
}

}  // namespace etlc::emit
