// The streams of judge(): present and past of every position, and the futures of sliding monitors.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::Slot;
using plan::Stream;
using plan::StreamOp;

/// The operand where its position lies in the trace, else what counts as nothing.
std::string guarded(const Context& context, const Stream& stream, std::size_t i, const std::string& where_none) {
    const std::string value = context.value(stream.operands[i]);
    const bool trace_may_end = context.plan.has_sliding;  // finish() moves on beyond the last position
    if (stream.operand_lag == 0 && (stream.lag == 0 || !trace_may_end)) return value;
    return fmt::format("exists({}) ? {} : {}", stream.operand_lag, value, where_none);
}

bool is_max(StreamOp op) {
    return op == StreamOp::running_max || op == StreamOp::window_max || op == StreamOp::since ||
           op == StreamOp::window_since || op == StreamOp::window_until;
}

std::string monoid(StreamOp op) {
    switch (op) {
        case StreamOp::window_max: return "etlmon::Greatest";
        case StreamOp::window_min: return "etlmon::Least";
        case StreamOp::window_since: return "etlmon::Since";
        case StreamOp::window_trigger: return "etlmon::Trigger";
        case StreamOp::window_until: return "etlmon::Until";
        default: return "etlmon::Release";
    }
}

bool is_window(StreamOp op) {
    return op == StreamOp::window_max || op == StreamOp::window_min || op == StreamOp::window_since ||
           op == StreamOp::window_trigger || op == StreamOp::window_until || op == StreamOp::window_release;
}

constexpr const char* kTrue = "etlmon::kTrue";
constexpr const char* kFalse = "etlmon::kFalse";

/// What the stream's value is computed from; empty for atoms and constants, which need no statement.
std::string statement(const Context& context, Slot slot) {
    const Stream& stream = context.plan.streams[slot];
    const std::string local = "const Value " + context.names.stream_local.at(slot) + " = ";
    const auto at = [&](std::size_t i) { return context.value(stream.operands[i]); };
    const auto kept = [&] { return context.names.stream_member.at(slot); };
    const bool max = is_max(stream.op);
    const char* none = max ? kFalse : kTrue;
    const char* other = max ? kTrue : kFalse;
    switch (stream.op) {
        case StreamOp::constant:
        case StreamOp::predicate:
        case StreamOp::flag: return "";
        case StreamOp::negation: return fmt::format("{}negate({});", local, at(0));
        case StreamOp::conjunction:
        case StreamOp::disjunction: {
            std::vector<std::string> operands;
            for (std::size_t i = 0; i < stream.operands.size(); ++i) operands.push_back(at(i));
            return fmt::format("{}{};", local, call(stream.op == StreamOp::conjunction ? "min" : "max", operands));
        }
        case StreamOp::within:
            return fmt::format("{}{} ? {} : {};", local, open_condition(stream.interval), at(0),
                               value_literal(stream.value));
        case StreamOp::delay: return fmt::format("{}{}.push({});", local, kept(), at(0));
        case StreamOp::shift:
            return fmt::format("{}{}.push({});", local, kept(),
                               guarded(context, stream, 0, value_literal(stream.value)));
        case StreamOp::running_max:
        case StreamOp::running_min:
            return fmt::format("{0} = {1}({0}, {2});", kept(), max ? "max" : "min", guarded(context, stream, 0, none));
        case StreamOp::since:
        case StreamOp::trigger:
            return fmt::format("{0} = {1}({2}, {3}({0}, {4}));", kept(), max ? "max" : "min",
                               guarded(context, stream, 1, none), max ? "min" : "max",
                               guarded(context, stream, 0, other));
        case StreamOp::window_max:
        case StreamOp::window_min:
            if (stream.length == 1) return fmt::format("{}{};", local, guarded(context, stream, 0, none));
            return fmt::format("{}{}.push({});", local, kept(), guarded(context, stream, 0, none));
        default: break;
    }
    const std::string right = guarded(context, stream, 1, none);
    if (stream.length == 1) return fmt::format("{}{};", local, right);
    return fmt::format("{}{}.push({{{}, {}}}).value;", local, kept(), right, guarded(context, stream, 0, other));
}

std::string type_of(const Stream& stream) {
    if (stream.op == StreamOp::delay || stream.op == StreamOp::shift)
        return fmt::format("etlmon::Delay<Value, {}>", stream.length);
    if (is_window(stream.op)) return fmt::format("etlmon::Window<{}<Value>, {}>", monoid(stream.op), stream.length);
    return "Value";
}

std::string reset_of(const Stream& stream, const std::string& name) {
    if (stream.op == StreamOp::delay) return fmt::format("{}.reset({});", name, kFalse);
    if (stream.op == StreamOp::shift) return fmt::format("{}.reset({});", name, value_literal(stream.value));
    if (is_window(stream.op)) return fmt::format("{}.reset();", name);
    return fmt::format("{} = {};", name, is_max(stream.op) ? kFalse : kTrue);
}

}  // namespace

void print_streams(Printer& out, const Context& context) {
    for (Slot slot = 0; slot < context.plan.streams.size(); ++slot) {
        const std::string text = statement(context, slot);
        if (text.empty()) continue;
        const plan::NodeId node = context.plan.streams[slot].node;
        if (node != plan::kNone && context.plan.streams[slot].op != StreamOp::negation) {
            out.gap();
            out.line("// {}", context.place(node));
        }
        print_wrapped(out, text);
    }
}

std::vector<Member> stream_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [slot, name] : context.names.stream_member) {
        const Stream& stream = context.plan.streams[slot];
        const std::string comment = stream.node == plan::kNone ? "" : context.graph.text(stream.node);
        result.push_back({type_of(stream), name, comment, reset_of(stream, name)});
    }
    return result;
}

}  // namespace etlc::emit
