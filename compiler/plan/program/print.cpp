// The plan as text, for --emit plan.
#include <fmt/format.h>

#include "plan/plan.hpp"

namespace etlc::plan {

namespace {

std::string key_text(Key key) {
    return fmt::format("{}", etlmon::float_of(key));
}

std::string value_text(Value value) {
    if (value.low == value.high) return key_text(value.low);
    return fmt::format("[{}, {}]", key_text(value.low), key_text(value.high));
}

/// What --emit plan calls an operation and its dual.
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
        case StreamOp::widening: return either("widening max", "widening min");
        case StreamOp::since: return either("since", "trigger");
        case StreamOp::window_since: return either("window since", "window trigger");
        case StreamOp::window_until: return either("window until", "window release");
    }
    return "";
}

/// F, G, U or R.
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

std::string owed(const ir::Graph& graph, const std::vector<NodeId>& obligations) {
    if (obligations.empty()) return "nothing owed";
    std::string text = "owes ";
    for (NodeId id : obligations) text += (text.size() > 5 ? ", " : "") + graph.text(id);
    return text;
}

std::string machine_text(const Machine& machine, const ir::Graph& graph) {
    const Automaton& automaton = machine.automaton;
    std::string text =
        fmt::format("state machine of {} states, {} transitions, {}\n", automaton.states.size(),
                    automaton.transitions.size(), machine.unrolled ? "unrolled" : "as a table");
    for (std::size_t state = 0; state < automaton.states.size(); ++state) {
        text += fmt::format("       q{}: {}{}\n", state, owed(graph, automaton.states[state]),
                            machine.states[state].always_true ? ", always +inf" : "");
        for (const Transition& t : automaton.transitions) {
            if (t.target != state) continue;
            text += fmt::format("           from q{}", t.source);
            if (t.guard != 0) text += " where" + slots(machine.guards[t.guard]);
            text += "\n";
        }
    }
    return text;
}

std::string pending_text(const Pending& pending, const ir::Graph& graph) {
    std::string text = fmt::format("{}, over the last {} positions again at every step\n",
                                   pending.is_fold ? "fold" : "state machine", pending.horizon + 1);
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
    if (!pending.is_fold) text += "       " + machine_text(pending.machine, graph);
    return text;
}

std::string reading_text(const Reading& reading, const ir::Graph& graph) {
    std::string text;
    switch (reading.kind) {
        case Reading::Kind::latch:
            return fmt::format("latch of s{} at step 0\n", reading.latch.operand);
        case Reading::Kind::fold:
            text =
                fmt::format("fold {} over", symbol(reading.fold.max, reading.fold.left != kNone));
            if (reading.fold.left != kNone) text += fmt::format(" s{}", reading.fold.left);
            return text +
                   fmt::format(" s{}, unseen s{}\n", reading.fold.right, reading.fold.unseen);
        case Reading::Kind::pending: return pending_text(reading.pending, graph);
        case Reading::Kind::response:
            text = fmt::format("response, passed s{}", reading.response.passed);
            if (reading.response.pending != kNone)
                text += fmt::format(", pending s{}", reading.response.pending);
            if (reading.response.recent != kNone)
                text += fmt::format(", recent s{}", reading.response.recent);
            return text + fmt::format(", unseen s{} s{}\n", reading.response.unseen_answer,
                                      reading.response.unseen_body);
        case Reading::Kind::machine: return machine_text(reading.machine, graph);
        case Reading::Kind::combination: break;
    }
    text = reading.max ? "max" : "min";
    for (std::uint32_t operand : reading.operands) text += fmt::format(" r{}", operand);
    return text + "\n";
}

}  // namespace

std::string print(const Plan& plan) {
    const ir::Graph& graph = *plan.formulas;
    std::string text = fmt::format("plan {}\nstreams\n", plan.model->name);
    for (Slot slot = 0; slot < plan.streams.size(); ++slot) text += stream_text(plan, graph, slot);
    if (!plan.readings.empty()) text += "readings\n";
    for (std::size_t i = 0; i < plan.readings.size(); ++i) {
        std::string lines = reading_text(plan.readings[i], graph);
        lines.insert(lines.find('\n'), fmt::format("  // {}", graph.text(plan.readings[i].node)));
        text += fmt::format("  r{} = {}", i, lines);
    }
    text += "monitors\n";
    for (const Monitor& monitor : plan.monitors) {
        text += monitor.sliding ? fmt::format("  {} = s{}, about the position {} steps ago\n",
                                              monitor.name, monitor.stream, monitor.horizon)
                                : fmt::format("  {} = r{}\n", monitor.name, monitor.reading);
    }
    return text;
}

}  // namespace etlc::plan
