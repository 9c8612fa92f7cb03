// Prints restart functions, and the end of a step of monitors that restart.
#include "emit/context.hpp"

namespace etlc::emit {

void print_restarts(Printer& out, const Context& context, const std::vector<Member>& all) {
    for (std::uint32_t m = 0; m < context.plan.monitors.size(); ++m) {
        const plan::Monitor& monitor = context.plan.monitors[m];
        if (monitor.restarts == check::Restarts::never) continue;
        print_doc(out, fmt::format("Restarts {}: the next step is its first. Past operators still "
                                   "see the whole trace.",
                                   monitor.name));
        out.open(fmt::format("constexpr void restart_{}() noexcept {{", monitor.name));
        for (const Member& member : all)
            if (member.begins_with == m) out.line(member.reset);
        // A repeating monitor returns its verdict before it restarts.
        if (context.on_demand && monitor.restarts == check::Restarts::on_request)
            out.line("answers_.{} = {}();", monitor.name, context.spelling.verdict);
        if (context.plan.recorder) out.line("recorder_.restart({});", m);
        out.close();
        const auto alarms = context.names.alarms_member.find(m);
        if (alarms != context.names.alarms_member.end()) {
            print_doc(out, "The number of times it raised an alarm, and was fulfilled.");
            out.line("uint32_t alarms_{}() const noexcept {{ return {}; }}", monitor.name,
                     alarms->second);
            out.line("uint32_t fulfilled_{}() const noexcept {{ return {}; }}", monitor.name,
                     context.names.fulfilled_member.at(m));
        }
        out.line();
    }
}

namespace {

/// Prints the restart after a final verdict.
void print_next_cycle(Printer& out, const Context& context, std::size_t m,
                      const std::string& verdict) {
    const auto open = context.names.open_local.find(m);
    const std::string while_open = open != context.names.open_local.end() ? open->second + " && "
                                   : context.plan.has_sliding             ? "finishes_ == 0 && "
                                                                          : "";
    out.gap();
    print_comment(out, "//",
                  fmt::format("after a final verdict, {} restarts with the next step",
                              context.plan.monitors[m].name));
    out.open(fmt::format("if ({}{}.final()) {{", while_open, verdict));
    out.line("uint32_t& count = {}.alarm() ? {} : {};", verdict, context.names.alarms_member.at(m),
             context.names.fulfilled_member.at(m));
    print_wrapped(out, counted("count"));
    out.line("restart_{}();", context.plan.monitors[m].name);
    if (const auto position = context.names.position_member.find(m);
        position != context.names.position_member.end()) {
        out.close(fmt::format("}} else if ({} != UINT32_MAX) {{", position->second));
        out.indent();
        out.line("++{};", position->second);
    }
    out.close();
}

}  // namespace

void print_progress(Printer& out, const Context& context, std::string_view verdicts) {
    const std::vector<plan::Monitor>& monitors = context.plan.monitors;
    for (std::size_t m = 0; m < monitors.size(); ++m) {
        if (monitors[m].restarts == check::Restarts::when_final)
            print_next_cycle(out, context, m, fmt::format("{}.{}", verdicts, monitors[m].name));
        else if (monitors[m].counts_steps)
            print_wrapped(out, counted(context.names.position_member.at(m)));
    }
}

}  // namespace etlc::emit
