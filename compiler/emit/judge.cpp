// Prints judge(): from the robustness of every predicate at this step to the verdicts.

#include <algorithm>

#include "emit/context.hpp"

namespace etlc::emit {

namespace {

/// Returns ", SHIFT" or ", LEAST, MOST" of a monitor that was calibrated as a whole.
std::string shifts(const plan::Monitor& monitor) {
    if (!monitor.shifted) return "";
    const std::string shift = ", " + float_literal(monitor.shift);
    return monitor.inner_shift ? ", " + float_literal(*monitor.inner_shift) + shift : shift;
}

/// Returns the value, shifted with its bounds if the monitor was calibrated as a whole.
std::string shifted(const plan::Monitor& monitor, const std::string& value) {
    return monitor.shifted ? fmt::format("etlmon::shifted({}{})", value, shifts(monitor)) : value;
}

/// Returns ", CONDITION" under which the prefix has all that the formula looks ahead, so that even
/// an unknown verdict is final; nothing if it looks ahead without a limit.
std::string complete(const Context& context, std::size_t m) {
    const plan::Monitor& monitor = context.plan.monitors[m];
    if (monitor.ahead == plan::kUnbounded) return "";
    if (monitor.ahead == 0) return ", true";
    const std::uint32_t from = monitor.begins_with(static_cast<std::uint32_t>(m));
    return fmt::format(", {} >= {}", context.position(from), monitor.ahead);
}

/// Returns the reading or value without its sample.
std::string robustness(const Context& context, const std::string& value) {
    return context.explains ? fmt::format("etlmon::unsourced({})", value) : value;
}

/// Returns the verdict from values that carry their sample, and keeps the one that decides it.
std::string deciding(const plan::Monitor& monitor, std::string_view kind, std::size_t m,
                     const std::string& value, const std::string& complete = "") {
    return fmt::format("deciding_.{}({}, {}{}{})", kind, m, value, shifts(monitor), complete);
}

bool is_deciding(const Context& context) {
    return context.explains && !context.sampled.places.empty();
}

std::string prefix_verdict(const Context& context, std::size_t m) {
    const plan::Monitor& monitor = context.plan.monitors[m];
    const std::string reading = context.reading(monitor.reading);
    const std::string when = complete(context, m);
    if (is_deciding(context)) return deciding(monitor, "prefix", m, reading, when);
    return fmt::format("etlmon::prefix_verdict({}{})",
                       shifted(monitor, robustness(context, reading)), when);
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

void print_readings(Printer& out, const Context& context, std::uint32_t part = plan::kNone) {
    const plan::Plan& plan = context.plan;
    const std::vector<std::uint32_t>& parts = context.parts.of_reading;
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) return;
    const bool ends =
        plan.has_sliding && !context.on_demand;  // the prefix does not grow during finish()
    if (ends) {
        out.gap();
        out.open("if (finishes_ == 0) {");
    }
    for (std::uint32_t r = 0; r < plan.readings.size(); ++r) {
        if (parts[r] != part) continue;
        out.gap();
        print_comment(out, "//", context.place(plan.readings[r].node), 4);
        context.on_demand ? print_reading_while_open(out, context, r)
                          : print_reading(out, context, r);
    }
    if (!ends) return;
    for (const auto& [m, name] : context.names.verdict_member)
        if (context.parts.of_monitor[m] == part)
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
            print_wrapped(out, fmt::format("{}answers_.{} = etlmon::prefix_verdict({}{});",
                                           if_open(context, m), monitor.name,
                                           context.names.readings[monitor.reading].local,
                                           complete(context, m)));
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

namespace {

void print_verdicts(Printer& out, const Context& context, std::uint32_t part) {
    for (std::size_t m = 0; m < context.plan.monitors.size(); ++m) {
        if (context.parts.of_monitor[m] != part) continue;
        const std::string answer = "verdicts." + context.plan.monitors[m].name;
        print_wrapped(out, fmt::format("{} = {};", answer, verdict(context, m)));
    }
}

/// `unused`: what precedes a parameter that not every part reads.
std::string parameters_of_parts(const Context& context, std::string_view unused = "") {
    return fmt::format(
        "{0}const Atoms& now, {1}Verdicts& verdicts", unused,
        context.parts.share() ? fmt::format("{}const Shared& shared, ", unused) : "");
}

void print_part(Printer& out, const Context& context, std::uint32_t part) {
    print_wrapped(out, fmt::format("inline void Monitor::judge_{}({}) noexcept {{", part + 1,
                                   parameters_of_parts(context, "[[maybe_unused]] ")));
    out.indent();
    out.line("using etlmon::max_of;");
    out.line("using etlmon::min_of;");
    out.gap();
    print_streams(out, context, part);
    print_readings(out, context, part);
    out.gap();
    print_verdicts(out, context, part);
    out.close();
    out.line();
}

}  // namespace

namespace {

/// Returns the part of each monitor: as many as fit in one function of those that follow.
std::vector<std::uint32_t> parts_of_monitors(const plan::Plan& plan) {
    constexpr std::uint64_t kInAPart = 256;  // operations
    std::vector<std::uint32_t> parts;
    std::uint32_t part = 0;
    std::uint64_t sum = 0;
    for (const plan::Cost& cost : plan.monitor_costs) {
        sum += cost.operations;
        if (sum > kInAPart && sum > cost.operations) {
            ++part;
            sum = cost.operations;
        }
        parts.push_back(part);
    }
    return parts;
}

/// Returns the part that all these monitors are in; kNone if there is none, or lets are among them.
std::uint32_t common_part(const Parts& parts, const std::vector<std::size_t>& users) {
    if (users.empty() || users.back() >= parts.of_monitor.size()) return plan::kNone;
    const std::uint32_t first = parts.of_monitor[users.front()];
    return parts.of_monitor[users.back()] == first ? first : plan::kNone;  // both ascend
}

bool is_local(plan::StreamOp op) {
    using Op = plan::StreamOp;
    return op != Op::constant && op != Op::predicate && op != Op::flag && op != Op::running &&
           op != Op::since;
}

}  // namespace

Parts parts_of(const plan::Plan& plan, const plan::Dependents& dependents, bool on_demand) {
    constexpr std::uint64_t kInOneFunction = 2048;  // operations
    Parts parts;
    parts.of_monitor = parts_of_monitors(plan);
    parts.count = parts.of_monitor.empty() ? 0 : parts.of_monitor.back() + 1;
    if (on_demand || parts.count < 2 || plan.cost.operations <= kInOneFunction) {
        parts.count = 0;
        parts.of_monitor.assign(plan.monitors.size(), plan::kNone);
    }
    for (const auto& users : dependents.of_stream)
        parts.of_stream.push_back(common_part(parts, users));
    for (const auto& users : dependents.of_reading)
        parts.of_reading.push_back(common_part(parts, users));
    if (parts.count == 0) return parts;
    for (plan::Slot slot = 0; slot < plan.streams.size(); ++slot)
        if (parts.of_stream[slot] == plan::kNone && is_local(plan.streams[slot].op))
            parts.shared_streams.push_back(slot);
    for (std::uint32_t r = 0; r < plan.readings.size(); ++r)
        if (parts.of_reading[r] == plan::kNone) parts.shared_readings.push_back(r);
    return parts;
}

void declare_parts(Printer& out, const Context& context) {
    if (context.parts.count == 0) return;
    if (context.parts.share()) {
        print_doc(out, "What several parts of judge() read.");
        out.open("struct Shared {");
        for (const plan::Slot slot : context.parts.shared_streams)
            out.line("Value {};", context.names.streams[slot].local);
        for (const std::uint32_t r : context.parts.shared_readings)
            out.line("Reading {};", context.names.readings[r].local);
        out.close("};");
        out.line();
    }
    print_doc(out, "The parts of judge(), each for some of the monitors.");
    for (std::uint32_t part = 0; part < context.parts.count; ++part)
        print_wrapped(out, fmt::format("void judge_{}({}) noexcept;", part + 1,
                                       parameters_of_parts(context)));
    out.line();
}

void print_judge(Printer& out, const Context& context) {
    const plan::Plan& plan = context.plan;
    for (std::uint32_t part = 0; part < context.parts.count; ++part) print_part(out, context, part);
    const bool reads_atoms =
        !context.names.predicate_atom.empty() || !context.names.flag_atom.empty() || plan.recorder;
    open_half(out, context, "Verdicts",
              fmt::format("judge({}const Atoms& now)", reads_atoms ? "" : "[[maybe_unused]] "));
    out.line("using etlmon::max_of;");
    out.line("using etlmon::min_of;");
    out.gap();
    if (context.parts.share()) out.line("Shared shared;");
    print_streams(out, context);
    print_readings(out, context);
    out.gap();
    out.line("Verdicts verdicts;");
    print_verdicts(out, context, plan::kNone);
    for (std::uint32_t part = 0; part < context.parts.count; ++part)
        out.line("judge_{}(now, {}verdicts);", part + 1, context.parts.share() ? "shared, " : "");
    print_lets(out, context);
    print_seen_verdicts(out, context, "verdicts");
    print_progress(out, context, "verdicts");
    print_record(out, context, "verdicts");
    if (plan.counts_steps) print_wrapped(out, counted("position_"));
    out.line("return verdicts;");
    out.close();
}

// Prints readings of formulas whose windows extend beyond the prefix, which are evaluated again at
// the last positions.

namespace {

using plan::kNone;
using plan::Pending;

/// Prints the readings of a part at the last positions, oldest first, from those of its operands.
void print_part(Printer& out, const Context& context, const Pending& pending,
                const Names::OfReading& names, std::size_t index, const std::string& leaf) {
    const Pending::Part& part = pending.parts[index];
    const std::string& array = names.parts[index];
    out.line("Reading {}[{}];", array, pending.horizon + 1);
    if (part.leaf != kNone) {
        out.line("{}.push({});", leaf, context.value(part.leaf));
        out.line("{}.list({}, {});", leaf, array, names.count);
        return;
    }
    print_comment(out, "//", context.graph.text(part.node), 4);
    if (part.unseen == kNone) {
        const char* function = part.max ? "pending_or" : "pending_and";
        std::string left = names.parts[part.operands[0]];
        for (std::size_t i = 1; i < part.operands.size(); ++i) {
            print_wrapped(out, fmt::format("etlmon::{}({}, {}, {}, {});", function, left,
                                           names.parts[part.operands[i]], array, names.count));
            left = array;
        }
        return;
    }
    const bool max = part.max;
    const std::string left = part.operands.size() == 2 ? names.parts[part.operands[0]] : "nullptr";
    print_wrapped(out,
                  fmt::format("etlmon::pending_at_each<etlmon::{}>({}, {}, {}, {}, {}, {}, {});",
                              max ? "Seeking" : "Guarding", left, names.parts[part.operands.back()],
                              array, names.count, part.interval.low, part.interval.high,
                              max ? context.high(part.unseen) : context.low(part.unseen)));
}

/// Returns code for the number of steps since the reading began.
const std::string& position(const Context& context, std::uint32_t r) {
    return context.position(context.plan.readings[r].begins_with);
}

void print_fold(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::OfReading& names = context.names.readings[r];
    const Pending::Part& fold = pending.fold;
    const bool max = fold.max;
    const std::string left = fold.operands.size() == 2 ? names.parts[fold.operands[0]] : "nullptr";
    const std::string end =
        fold.interval.bounded() ? fmt::format("{}", fold.interval.high) : "etlmon::kWithoutEnd";
    print_wrapped(out,
                  fmt::format("{} = etlmon::pending_from_start<etlmon::{}>({}, {}, {}, {}, {}, "
                              "{}, {}, {}, {}, {});",
                              reading_declaration(context, r), max ? "Seeking" : "Guarding",
                              *(names.members.end() - 2), names.members.back(), left,
                              names.parts[fold.operands.back()], names.count, position(context, r),
                              pending.horizon, fold.interval.low, end,
                              max ? context.high(fold.unseen) : context.low(fold.unseen)));
}

void print_machine(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::OfReading& names = context.names.readings[r];
    out.line("Reading {}[{}][{}];", names.guards, pending.horizon + 1, pending.table.guards.size());
    out.open(fmt::format("for (uint32_t i = 0; i < {0}; ++i) {{", names.count));
    for (std::size_t g = 0; g < pending.table.guards.size(); ++g) {
        std::vector<std::string> literals;
        for (std::uint32_t part : pending.table.guards[g])
            literals.push_back(names.parts[part] + "[i]");
        print_wrapped(out,
                      fmt::format("{}[i][{}] = {};", names.guards, g,
                                  literals.empty() ? fmt::format("etlmon::settled({})",
                                                                 context.literal(etlmon::kTrue))
                                                   : call("min_of", literals)));
    }
    out.close();
    print_machine_keys(out, context, r);
    const std::string tables = "tables::" + names.local;
    print_wrapped(
        out,
        fmt::format("{} = {}.read({}, {}, {} >= {}, {}_transitions, {}_ends, {}_pending, {}, {});",
                    reading_declaration(context, r), names.members.back(), names.guards,
                    names.count, position(context, r), pending.horizon, tables, tables, tables,
                    names.weak, names.strong));
}

}  // namespace

void print_pending(Printer& out, const Context& context, std::uint32_t r) {
    const Pending& pending = context.plan.readings[r].pending;
    const Names::OfReading& names = context.names.readings[r];
    out.line("// evaluated again at the last {} positions, whose windows extend beyond this step",
             pending.horizon + 1);
    out.line("const uint32_t {0} = {3} < {1} ? {3} + 1 : {2};", names.count, pending.horizon,
             pending.horizon + 1, position(context, r));
    auto leaf = names.members.begin();  // members of leaves come first
    for (std::size_t i = 0; i < pending.parts.size(); ++i) {
        print_part(out, context, pending, names, i, *leaf);
        if (pending.parts[i].leaf != kNone) ++leaf;
    }
    pending.is_fold ? print_fold(out, context, r) : print_machine(out, context, r);
}

// Prints restart functions, and the end of a step of monitors that restart.

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
    const std::string& alarms = context.names.alarms_member.at(m);
    const std::string& fulfilled = context.names.fulfilled_member.at(m);
    if (context.plan.monitors[m].ahead == plan::kUnbounded) {
        out.line("uint32_t& count = {}.alarm() ? {} : {};", verdict, alarms, fulfilled);
        print_wrapped(out, counted("count"));
    } else {  // it may be unknown for good
        print_wrapped(out,
                      fmt::format("if ({0}.alarm() && {1} != UINT32_MAX) ++{1};", verdict, alarms));
        print_wrapped(out, fmt::format("if ({0}.fulfilled() && {1} != UINT32_MAX) ++{1};", verdict,
                                       fulfilled));
    }
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
