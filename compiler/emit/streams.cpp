// The streams of judge(): present and past of every position, and the futures of sliding monitors.
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::Slot;
using plan::Stream;
using plan::StreamOp;

/// The operand where its position lies in the trace, else what counts as nothing.
std::string guarded(const Context& context, const Stream& stream, std::size_t i,
                    const std::string& where_none) {
    std::string value = context.value(stream.operands[i]);
    const bool trace_may_end =
        context.plan.has_sliding;  // finish() moves on beyond the last position
    if (stream.operand_lag == 0 && (stream.lag == 0 || !trace_may_end)) return value;
    if (context.lazy(stream.operands[i])) value = fmt::format("Value({})", value);
    return fmt::format("exists({}) ? {} : {}", stream.operand_lag, value, where_none);
}

bool is_max(StreamOp op) {
    return op == StreamOp::running_max || op == StreamOp::window_max || op == StreamOp::since ||
           op == StreamOp::window_since || op == StreamOp::window_until ||
           op == StreamOp::widening_max;
}

bool is_widening(StreamOp op) {
    return op == StreamOp::widening_max || op == StreamOp::widening_min;
}

std::string monoid(StreamOp op) {
    switch (op) {
        case StreamOp::widening_max:
        case StreamOp::window_max: return "etlmon::Greatest";
        case StreamOp::widening_min:
        case StreamOp::window_min: return "etlmon::Least";
        case StreamOp::window_since: return "etlmon::Since";
        case StreamOp::window_trigger: return "etlmon::Trigger";
        case StreamOp::window_until: return "etlmon::Until";
        default: return "etlmon::Release";
    }
}

bool is_window(StreamOp op) {
    return op == StreamOp::window_max || op == StreamOp::window_min ||
           op == StreamOp::window_since || op == StreamOp::window_trigger ||
           op == StreamOp::window_until || op == StreamOp::window_release;
}

/// The min or max of some streams.
std::string combination(const Context& context, StreamOp op, const std::vector<Slot>& slots) {
    std::vector<std::string> operands;
    bool lazy = false;
    for (Slot slot : context.by_work(slots)) {
        operands.push_back(context.value(slot));
        lazy = lazy || context.lazy(slot);
    }
    return call(op == StreamOp::conjunction ? "min_of" : "max_of", operands, lazy);
}

/// v = max(g, min(v, f)) or the dual; in a Boolean monitor the cheaper side is asked first.
std::string since(const Context& context, const Stream& stream, const std::string& kept) {
    const bool max = is_max(stream.op);
    const std::string none = max ? context.spelling.no : context.spelling.yes;
    const std::string other = max ? context.spelling.yes : context.spelling.no;
    const char* outer = max ? "max_of" : "min_of";
    const std::string right = guarded(context, stream, 1, none);
    const std::string left = fmt::format("{}({}, {})", max ? "min_of" : "max_of", kept,
                                         guarded(context, stream, 0, other));
    const bool left_first = context.work(stream.operands[0]) < context.work(stream.operands[1]);
    return left_first ? fmt::format("{}({}, {})", outer, left, right)
                      : fmt::format("{}({}, {})", outer, right, left);
}

/// The operand within its window, found out when it is asked for.
std::string lazy_within(const Context& context, const Stream& stream, const std::string& name) {
    return fmt::format("const etlmon::Lazy {}([&]() noexcept {{ return {} ? Value({}) : {}; }});",
                       name, open_condition(stream.interval), context.value(stream.operands[0]),
                       context.literal(stream.value));
}

/// The value of a statement, found out when it is first asked for.
std::string lazy_value(std::string statement, const std::string& name) {
    statement.pop_back();
    return fmt::format("const etlmon::Lazy {}([&]() noexcept {{ return Value({}); }});", name,
                       statement);
}

/// What the stream's value is computed from; empty for atoms and constants, which need no
/// statement.
std::string statement(const Context& context, Slot slot, const std::string& local) {
    const Stream& stream = context.plan.streams[slot];
    const auto at = [&](std::size_t i) { return context.value(stream.operands[i]); };
    const auto kept = [&] { return context.names.stream_member.at(slot); };
    const bool max = is_max(stream.op);
    const std::string none = max ? context.spelling.no : context.spelling.yes;
    const std::string other = max ? context.spelling.yes : context.spelling.no;
    switch (stream.op) {
        case StreamOp::constant:
        case StreamOp::predicate:
        case StreamOp::flag: return "";
        case StreamOp::negation: return fmt::format("{}etlmon::negate({});", local, at(0));
        case StreamOp::conjunction:
        case StreamOp::disjunction:
            return local + combination(context, stream.op, stream.operands) + ";";
        case StreamOp::within:
            return fmt::format("{}{} ? {} : {};", local, open_condition(stream.interval), at(0),
                               context.literal(stream.value));
        case StreamOp::delay: {
            // In a Boolean monitor a delayed atom is measured: not where the trace has ended.
            const bool lazy = context.lazy(stream.operands[0]) && context.plan.has_sliding;
            return fmt::format(
                "{}{}.push({});", local, kept(),
                lazy ? fmt::format("exists({}) ? Value({}) : {}", stream.operand_lag, at(0), none)
                     : at(0));
        }
        case StreamOp::shift:
            return fmt::format("{}{}.push({});", local, kept(),
                               guarded(context, stream, 0, context.literal(stream.value)));
        case StreamOp::running_max:
        case StreamOp::running_min:
            return fmt::format("{0} = {1}({0}, {2});", kept(), max ? "max_of" : "min_of",
                               guarded(context, stream, 0, none));
        case StreamOp::since:
        case StreamOp::trigger:
            return fmt::format("{} = {};", kept(), since(context, stream, kept()));
        case StreamOp::widening_max:
        case StreamOp::widening_min: return fmt::format("{}{}.push({});", local, kept(), at(0));
        case StreamOp::window_max:
        case StreamOp::window_min:
            if (stream.length == 1)
                return fmt::format("{}{};", local, guarded(context, stream, 0, none));
            return fmt::format("{}{}.push({});", local, kept(), guarded(context, stream, 0, none));
        default: break;
    }
    const std::string right = guarded(context, stream, 1, none);
    if (stream.length == 1) return fmt::format("{}{};", local, right);
    return fmt::format("{}{}.push({{{}, {}}}).value;", local, kept(), right,
                       guarded(context, stream, 0, other));
}

std::string type_of(const Context& context, const Stream& stream) {
    if (stream.op == StreamOp::delay || stream.op == StreamOp::shift)
        return fmt::format("etlmon::Delay<Value, {}>", stream.length);
    if (is_window(stream.op))
        return fmt::format("etlmon::Window<{}<Value>, {}>", monoid(stream.op), stream.length);
    if (is_widening(stream.op))
        return fmt::format("etlmon::Widening<{}<Value>, {}, {}>", monoid(stream.op),
                           stream.from_length, stream.length);
    return context.spelling.kept;
}

std::string reset_of(const Context& context, const Stream& stream, const std::string& name) {
    if (stream.op == StreamOp::delay)
        return fmt::format("{}.reset({});", name, context.spelling.no);
    if (stream.op == StreamOp::shift)
        return fmt::format("{}.reset({});", name, context.literal(stream.value));
    if (is_window(stream.op) || is_widening(stream.op)) return fmt::format("{}.reset();", name);
    if (stream.op == StreamOp::since || stream.op == StreamOp::trigger)
        return fmt::format("{} = {};", name, context.literal(stream.value));
    return fmt::format("{} = {};", name,
                       is_max(stream.op) ? context.spelling.no : context.spelling.yes);
}

struct Statement {
    std::string text;         ///< empty: none is needed
    std::string declaration;  ///< what has to stand before it, if anything
};

/// The statement with what it declares. In a Boolean monitor, what must remember is only kept up
/// while some verdict depends on it, and what need not is found out when it is asked for.
Statement whole_statement(const Context& context, Slot slot) {
    const auto local = context.names.stream_local.find(slot);
    if (local == context.names.stream_local.end()) return {};  // an atom or a constant
    const std::string& name = local->second;
    const Stream& stream = context.plan.streams[slot];
    if (context.lazy(slot) && stream.op == StreamOp::within)
        return {lazy_within(context, stream, name), ""};
    if (context.keeps(slot)) return {lazy_value(statement(context, slot, ""), name), ""};
    if (context.lazy(slot)) return {statement(context, slot, "const auto " + name + " = "), ""};
    const std::string condition = open_monitors(context, context.dependents.of_stream[slot]);
    const bool remembers = context.names.stream_member.count(slot) > 0;
    if (!remembers || condition.empty())
        return {statement(context, slot, "const Value " + name + " = "), ""};
    const std::string text = statement(context, slot, name + " = ");
    const bool sets_local = text.starts_with(name + " = ");
    return {fmt::format("if ({}) {}", condition, text),
            sets_local ? fmt::format("Value {}{{}};", name) : ""};
}

}  // namespace

std::string stream_text(const ir::Graph& graph, const Stream& stream) {
    if (stream.node != plan::kNone) return graph.text(stream.node);
    if (stream.op == StreamOp::since || stream.op == StreamOp::trigger)
        return "what is asked and not yet answered";
    if (!is_window(stream.op) && !is_widening(stream.op)) return "";
    return fmt::format("the {} over the last {} steps", is_max(stream.op) ? "max" : "min",
                       stream.length);
}

void print_streams(Printer& out, const Context& context) {
    for (Slot slot = 0; slot < context.plan.streams.size(); ++slot) {
        const Statement statement = whole_statement(context, slot);
        if (statement.text.empty()) continue;
        const plan::NodeId node = context.plan.streams[slot].node;
        if (node != plan::kNone && context.plan.streams[slot].op != StreamOp::negation) {
            out.gap();
            out.line("// {}", context.place(node));
        }
        if (!statement.declaration.empty()) out.line(statement.declaration);
        print_wrapped(out, statement.text);
    }
}

std::vector<Member> stream_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [slot, name] : context.names.stream_member) {
        const Stream& stream = context.plan.streams[slot];
        const std::string comment = stream_text(context.graph, stream);
        result.push_back(
            {type_of(context, stream), name, comment, reset_of(context, stream, name)});
    }
    return result;
}

}  // namespace etlc::emit
