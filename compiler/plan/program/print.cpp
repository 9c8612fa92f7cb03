// Prints the plan: `--emit plan`.
#include <fmt/format.h>

#include "plan/program/program.hpp"

namespace etlc::plan {

namespace {

std::string key_text(Key key) {
    return fmt::format("{}", etlmon::float_of(key));
}

std::string value_text(Value value) {
    if (value.low == value.high) return key_text(value.low);
    return fmt::format("[{}, {}]", key_text(value.low), key_text(value.high));
}

/// Returns the name of an operation or of its dual.
const char* name(const Stream& stream) {
    const auto either = [&](const char* max, const char* min) { return stream.max ? max : min; };
    switch (stream.op) {
        case StreamOp::constant: return "constant";
        case StreamOp::predicate: return "predicate";
        case StreamOp::flag: return "flag";
        case StreamOp::negation: return "not";
        case StreamOp::combination: return either("max", "min");
        case StreamOp::within: return "within";
        case StreamOp::delay: return "delay";
        case StreamOp::shift: return "shift";
        case StreamOp::running: return either("running max", "running min");
        case StreamOp::window: return either("window max", "window min");
        case StreamOp::window_count: return either("window at least", "window all but");
        case StreamOp::widening: return either("widening max", "widening min");
        case StreamOp::since: return either("since", "trigger");
        case StreamOp::window_since: return either("window since", "window trigger");
        case StreamOp::window_until: return either("window until", "window release");
        case StreamOp::window_handover: return either("window handover", "window covered");
    }
    return "";
}

/// Returns F, G, U or R.
const char* symbol(bool max, bool binary) {
    if (binary) return max ? "U" : "R";
    return max ? "F" : "G";
}

std::string slots(const std::vector<Slot>& operands) {
    std::string text;
    for (Slot slot : operands) text += fmt::format(" s{}", slot);
    return text;
}

std::string stream_text(const Plan& plan, const ir::Graph& graph, Slot slot) {
    const Stream& s = plan.streams[slot];
    const check::Model& model = *plan.model;
    std::string text = fmt::format("  s{} = {}", slot, name(s));
    if (s.op == StreamOp::constant) text += " " + value_text(s.value);
    if (s.op == StreamOp::predicate) text += " " + model.predicates[s.index].name;
    if (s.op == StreamOp::flag) text += " " + model.inputs[s.index].name;
    if (s.op == StreamOp::window_count) text += fmt::format(" {} of", s.index);
    text += slots(s.operands);
    if (s.length != 0) text += fmt::format(" over {}", s.length);
    if (s.op == StreamOp::within)
        text += fmt::format(" positions {} to {}, else {}", s.interval.low,
                            s.interval.bounded() ? fmt::format("{}", s.interval.high) : "the end",
                            value_text(s.value));
    if (s.op == StreamOp::shift || s.op == StreamOp::since) text += " from " + value_text(s.value);
    if (s.lag != 0) text += fmt::format(", {} steps late", s.lag);
    if (s.node != kNone) text += fmt::format("  // {}", graph.text(s.node));
    return text + "\n";
}

std::string obligations_text(const ir::Graph& graph, const std::vector<NodeId>& obligations) {
    if (obligations.empty()) return "nothing pending";
    std::string text = "pending: ";
    for (NodeId id : obligations) text += (text.size() > 9 ? ", " : "") + graph.text(id);
    return text;
}

/// Prints a term, or one end of it: "max(v0, s3)", with the reading's registers v, its locals t,
/// and streams s.
std::string term_text(const Term& term, End end = End::both) {
    const char* part = end == End::both ? "" : end == End::low ? ".low" : ".high";
    switch (term.kind) {
        case Term::Kind::constant: return value_text(term.value);
        case Term::Kind::stream: return fmt::format("s{}{}", term.index, part);
        case Term::Kind::reg: return fmt::format("v{}{}", term.index, part);
        case Term::Kind::local: return fmt::format("t{}{}", term.index, part);
        case Term::Kind::extreme: break;
        case Term::Kind::before:
            return fmt::format("{} before position {}, then {}", term_text(term.operands[0], end),
                               term.index, term_text(term.operands[1], end));
    }
    std::string text;
    for (const Term& operand : term.operands)
        text += (text.empty() ? "" : ", ") + term_text(operand, end);
    return fmt::format("{}({})", term.max ? "max" : "min", text);
}

std::string straight_text(const Straight& code, NodeId node, const ir::Graph& graph) {
    std::string text;
    for (std::size_t i = 0; i < code.registers.size(); ++i) {
        const std::string comment = comment_of(code.registers[i], graph);
        text += fmt::format("       v{} from {}", i, value_text(code.registers[i].first));
        text += comment == graph.text(node) ? "\n" : "  // " + comment + "\n";
    }
    for (const Assignment& assignment : code.assignments) {
        const auto [low, high] = assignment.positions;
        text += fmt::format("       {}{} = {}", assignment.target == Term::Kind::reg ? "v" : "t",
                            assignment.index, term_text(assignment.value));
        if (assignment.positions != ir::Interval{})
            text += fmt::format(", at positions {} to {}", low,
                                high == kUnbounded ? "the end" : fmt::format("{}", high));
        text += "\n";
    }
    return text + fmt::format("       rho {}; lower {}; upper {}\n", term_text(code.rho),
                              term_text(code.lower, End::low), term_text(code.upper, End::high));
}

std::string table_text(const Table& table, char guarded, const ir::Graph& graph) {
    std::string text;
    std::uint32_t begin = 0;
    for (std::size_t state = 0; state < table.ends.size(); ++state) {
        text += fmt::format("       q{}: {}\n", state,
                            obligations_text(graph, table.obligations[state]));
        for (std::uint32_t i = begin; i < table.ends[state]; ++i) {
            const etlmon::Transition t = table.transitions[i];
            text += fmt::format("           from q{}", t.source);
            if (t.guard != 0) text += " where";
            for (std::uint32_t operand : table.guards[t.guard])
                text += fmt::format(" {}{}", guarded, operand);
            text += "\n";
        }
        begin = table.ends[state];
    }
    return text;
}

std::string pending_text(const Pending& pending, const ir::Graph& graph) {
    std::string text;
    for (std::size_t i = 0; i < pending.parts.size(); ++i) {
        const Pending::Part& part = pending.parts[i];
        text += fmt::format("       p{} =", i);
        if (part.leaf != kNone) text += fmt::format(" s{}", part.leaf);
        if (part.leaf == kNone)
            text += fmt::format(" {}", part.unseen == kNone
                                           ? (part.max ? "||" : "&&")
                                           : symbol(part.max, part.operands.size() == 2));
        for (std::uint32_t operand : part.operands) text += fmt::format(" p{}", operand);
        text += fmt::format("  // {}\n", graph.text(part.node));
    }
    return pending.is_fold ? text : text + table_text(pending.table, 'p', graph);
}

std::string restarting(check::Restarts restarts) {
    switch (restarts) {
        case check::Restarts::never: break;
        case check::Restarts::on_request: return ", which restarts on request";
        case check::Restarts::when_final: return ", which restarts after a final verdict";
    }
    return "";
}

std::string reading_text(const Reading& reading, const ir::Graph& graph) {
    std::string text = reading.as;
    for (std::uint32_t operand : reading.operands) text += fmt::format(" r{}", operand);
    text += fmt::format("  // {}\n", graph.text(reading.node));
    switch (reading.kind) {
        case Reading::Kind::straight:
            return text + straight_text(reading.straight, reading.node, graph);
        case Reading::Kind::table: return text + table_text(reading.table, 's', graph);
        case Reading::Kind::pending: return text + pending_text(reading.pending, graph);
        case Reading::Kind::combination: break;
    }
    return text;
}

}  // namespace

std::string print(const Plan& plan) {
    const ir::Graph& graph = *plan.formulas;
    std::string text = fmt::format("plan {}\n", plan.model->name);
    if (!plan.pasts.empty()) text += "numbers of earlier steps\n";
    for (const Index past : plan.pasts) text += fmt::format("  {}\n", plan.model->pasts[past].text);
    text += "streams\n";
    for (Slot slot = 0; slot < plan.streams.size(); ++slot) text += stream_text(plan, graph, slot);
    if (!plan.readings.empty()) text += "readings\n";
    for (std::size_t i = 0; i < plan.readings.size(); ++i)
        text += fmt::format("  r{} = {}", i, reading_text(plan.readings[i], graph));
    text += "monitors\n";
    for (const Monitor& monitor : plan.monitors) {
        text += monitor.sliding ? fmt::format("  {} = s{}, about the position {} steps ago\n",
                                              monitor.name, monitor.stream, monitor.horizon)
                                : fmt::format("  {} = r{}{}\n", monitor.name, monitor.reading,
                                              restarting(monitor.restarts));
    }
    if (!plan.lets.empty()) text += "lets\n";
    for (const Let& let : plan.lets)
        text += fmt::format("  {} = s{}\n", plan.model->lets[let.index].name, let.stream);
    return text;
}

}  // namespace etlc::plan
