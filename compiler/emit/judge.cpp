// judge(): from the robustness of every predicate at this step to the verdicts.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

std::string verdict(const Context& context, std::size_t m) {
    const plan::Monitor& monitor = context.plan.monitors[m];
    if (monitor.sliding)
        return fmt::format("exists({}) ? etlmon::sliding_verdict({}) : etlmon::Verdict()", monitor.horizon,
                           context.value(monitor.stream));
    if (context.plan.has_sliding) return context.names.verdict_member.at(m);
    return fmt::format("etlmon::prefix_verdict({})", context.names.reading_local.at(monitor.reading));
}

void print_readings(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    if (plan.readings.empty()) return;
    const bool ends = plan.has_sliding;  // prefixes do not grow while finish() reports the last positions
    if (ends) {
        out.gap();
        out.open("if (finished_ == 0) {");
    }
    for (std::uint32_t r = 0; r < plan.readings.size(); ++r) {
        out.gap();
        out.line("// {}", context.place(plan.readings[r].node));
        print_reading(out, context, r);
    }
    if (!ends) return;
    for (const auto& [m, name] : context.names.verdict_member)
        out.line("{} = etlmon::prefix_verdict({});", name, context.names.reading_local.at(plan.monitors[m].reading));
    out.close();
}

}  // namespace

void print_judge(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    const bool reads_atoms = !context.names.predicate_atom.empty() || !context.names.flag_atom.empty();
    out.line(
        "/// One step of every formula, given this step's predicates. A Reading is rho on the prefix, and the lower "
        "and upper");
    out.line("/// bound that no continuation leaves.");
    out.open(fmt::format("Verdicts judge({}const Atoms& now) noexcept {{", reads_atoms ? "" : "[[maybe_unused]] "));
    out.line("using etlmon::max;");
    out.line("using etlmon::min;");
    out.gap();
    print_streams(out, context);
    print_readings(out, context);
    out.gap();
    out.line("Verdicts verdicts;");
    for (std::size_t m = 0; m < plan.monitors.size(); ++m)
        print_wrapped(out, fmt::format("verdicts.{} = {};", plan.monitors[m].name, verdict(context, m)));
    if (plan.counts_steps) out.line("if (step_ != 0xffffffffu) ++step_;");
    out.line("return verdicts;");
    out.close();
}

}  // namespace etlc::emit
