// Prints the streams of judge(): present and past of every position, and the futures of sliding
// monitors.

#include <algorithm>

#include "diag/diag.hpp"
#include "emit/context.hpp"

namespace etlc::emit {

namespace {

using plan::Slot;
using plan::Stream;
using plan::StreamOp;

/// Returns code for the operand, or for the neutral value if its position lies outside the trace.
std::string guarded(const Context& context, const Stream& stream, std::size_t i,
                    const std::string& where_none) {
    std::string value = context.value(stream.operands[i]);
    const bool trace_may_end =
        context.plan.has_sliding;  // finish() advances beyond the last position
    if (stream.operand_lag == 0 && (stream.lag == 0 || !trace_may_end)) return value;
    if (context.lazy(stream.operands[i])) value = fmt::format("static_cast<Value>({})", value);
    return fmt::format("exists({}) ? {} : {}", stream.operand_lag, value, where_none);
}

/// Returns code for the min or max of some streams.
std::string combination(const Context& context, bool max, const std::vector<Slot>& slots) {
    std::vector<std::string> operands;
    bool lazy = false;
    for (Slot slot : context.by_work(slots)) {
        operands.push_back(context.value(slot));
        lazy = lazy || context.lazy(slot);
    }
    return call(max ? "max_of" : "min_of", operands, lazy);
}

/// Returns code for max(g, min(v, f)) or the dual. A Boolean monitor evaluates the cheaper side
/// first.
std::string since(const Context& context, const Stream& stream, const std::string& kept) {
    const bool max = stream.max;
    const std::string none = context.literal(plan::neutral(max));
    const std::string other = context.literal(plan::neutral(!max));
    const char* outer = max ? "max_of" : "min_of";
    const std::string right = guarded(context, stream, 1, none);
    const std::string left = fmt::format("{}({}, {})", max ? "min_of" : "max_of", kept,
                                         guarded(context, stream, 0, other));
    const bool left_first = context.work(stream.operands[0]) < context.work(stream.operands[1]);
    return left_first ? fmt::format("{}({}, {})", outer, left, right)
                      : fmt::format("{}({}, {})", outer, right, left);
}

/// Declares the operand within its window, evaluated on demand.
std::string lazy_within(const Context& context, const Stream& stream, const std::string& name) {
    return fmt::format(
        "const etlmon::Lazy {}([&]() noexcept {{ return {} ? static_cast<Value>({}) : {}; }});",
        name, open_condition(stream.interval, context.position(stream.begins_with)),
        context.value(stream.operands[0]), context.literal(stream.value));
}

/// Declares the value of a statement, evaluated once, on demand.
std::string lazy_value(std::string statement, const std::string& name) {
    statement.pop_back();
    return fmt::format("const etlmon::Lazy {}([&]() noexcept -> Value {{ return {}; }});", name,
                       statement);
}

/// Returns the statement that computes the stream; empty for atoms and constants.
std::string statement(const Context& context, Slot slot, const std::string& local) {
    const Stream& stream = context.plan.streams[slot];
    const auto at = [&](std::size_t i) { return context.value(stream.operands[i]); };
    const auto kept = [&] { return context.names.streams[slot].member; };
    const bool max = stream.max;
    const std::string none = context.literal(plan::neutral(max));
    const std::string other = context.literal(plan::neutral(!max));
    switch (stream.op) {
        case StreamOp::constant:
        case StreamOp::predicate:
        case StreamOp::flag: return "";
        case StreamOp::negation: return fmt::format("{}etlmon::negate({});", local, at(0));
        case StreamOp::combination: return local + combination(context, max, stream.operands) + ";";
        case StreamOp::within:
            return fmt::format(
                "{}{} ? {} : {};", local,
                open_condition(stream.interval, context.position(stream.begins_with)), at(0),
                context.literal(stream.value));
        case StreamOp::delay: {
            // In a Boolean monitor a delayed atom is measured only before the end of the trace.
            const bool lazy = context.lazy(stream.operands[0]) && context.plan.has_sliding;
            return fmt::format("{}{}.push({});", local, kept(),
                               lazy ? fmt::format("exists({}) ? static_cast<Value>({}) : {}",
                                                  stream.operand_lag, at(0), other)
                                    : at(0));
        }
        case StreamOp::shift:
            return fmt::format("{}{}.push({});", local, kept(),
                               guarded(context, stream, 0, context.literal(stream.value)));
        case StreamOp::running:
            return fmt::format("{0} = {1}({0}, {2});", kept(), max ? "max_of" : "min_of",
                               guarded(context, stream, 0, none));
        case StreamOp::since:
            return fmt::format("{} = {};", kept(), since(context, stream, kept()));
        case StreamOp::widening: return fmt::format("{}{}.push({});", local, kept(), at(0));
        case StreamOp::window:
            if (stream.length == 1)
                return fmt::format("{}{};", local, guarded(context, stream, 0, none));
            return fmt::format("{}{}.push({});", local, kept(), guarded(context, stream, 0, none));
        case StreamOp::window_count:
            return fmt::format("{}{}.push({});", local, kept(), guarded(context, stream, 0, none));
        case StreamOp::window_handover:
            return fmt::format("{}{}.push(etlmon::{}<Value>::at({}, {})).value;", local, kept(),
                               max ? "Handover" : "Covered", at(0), at(1));
        case StreamOp::window_since:
        case StreamOp::window_until: break;
    }
    const std::string right = guarded(context, stream, 1, none);
    if (stream.length == 1) return fmt::format("{}{};", local, right);
    return fmt::format("{}{}.push({{{}, {}}}).value;", local, kept(), right,
                       guarded(context, stream, 0, other));
}

struct Statement {
    std::string text;         ///< empty: no statement
    std::string declaration;  ///< declaration before it, if any
};

/// Returns the condition under which a stream with state is updated. Monitors that restart and lets
/// need a past that began with the trace, so it is then updated at every step.
std::string while_open(const Context& context, Slot slot) {
    const std::vector<std::size_t>& monitors = context.dependents.of_stream[slot];
    const bool asked_again = context.plan.streams[slot].begins_with == plan::kNone &&
                             std::any_of(monitors.begin(), monitors.end(), [&](std::size_t m) {
                                 return m >= context.plan.monitors.size() ||
                                        context.plan.monitors[m].restarts != check::Restarts::never;
                             });
    return asked_again ? "" : open_monitors(context, monitors);
}

/// Returns the statement with its declaration. In a Boolean monitor, streams with state are updated
/// only while some verdict depends on them, and others are evaluated on demand.
Statement whole_statement(const Context& context, Slot slot) {
    const std::string& member = context.names.streams[slot].member;
    if (context.names.streams[slot].local.empty()) return {};  // an atom or a constant
    const std::string name = context.local(slot);
    if (name != context.names.streams[slot].local)
        return {statement(context, slot, name + " = "), ""};
    const Stream& stream = context.plan.streams[slot];
    if (context.lazy(slot) && stream.op == StreamOp::within)
        return {lazy_within(context, stream, name), ""};
    if (context.keeps(slot)) return {lazy_value(statement(context, slot, ""), name), ""};
    if (context.lazy(slot)) return {statement(context, slot, "const auto " + name + " = "), ""};
    const std::string condition = while_open(context, slot);
    if (member.empty() || condition.empty())
        return {statement(context, slot, "const Value " + name + " = "), ""};
    const std::string text = statement(context, slot, name + " = ");
    const bool sets_local = text.starts_with(name + " = ");
    return {fmt::format("if ({}) {}", condition, text),
            sets_local ? fmt::format("Value {}{{}};", name) : ""};
}

}  // namespace

void print_streams(Printer& out, const Context& context, std::uint32_t part) {
    for (Slot slot = 0; slot < context.plan.streams.size(); ++slot) {
        if (context.parts.of_stream[slot] != part) continue;
        const Statement statement = whole_statement(context, slot);
        if (statement.text.empty()) continue;
        const plan::NodeId node = context.plan.streams[slot].node;
        if (node != plan::kNone && context.plan.streams[slot].op != StreamOp::negation) {
            out.gap();
            print_comment(out, "//", context.place(node), 4);
        }
        if (!statement.declaration.empty()) out.line(statement.declaration);
        // A stream without a formula has a comment on its value.
        const bool in_between = node == plan::kNone && !context.lazy(slot);
        print_with_comment(
            out, statement.text,
            in_between ? plan::text_of(context.plan.streams[slot], context.graph) : "");
    }
}

// Declares the members that the plan lists for readings, streams and numbers of earlier steps.

namespace {

using Kind = plan::Member::Kind;

std::string aggregate(const plan::Member& member, const char* max, const char* min) {
    return fmt::format("etlmon::{}<Value>", member.max ? max : min);
}

std::string type_of(const Context& context, const plan::Member& m) {
    switch (m.kind) {
        case Kind::value: return context.spelling.kept;
        case Kind::variable: return "Value";
        case Kind::delay: return fmt::format("etlmon::Delay<Value, {}>", m.length);
        case Kind::window:
            return fmt::format("etlmon::Window<{}, {}>", aggregate(m, "Greatest", "Least"),
                               m.length);
        case Kind::since_window:
            return fmt::format("etlmon::Window<{}, {}>", aggregate(m, "Since", "Trigger"),
                               m.length);
        case Kind::until_window:
            return fmt::format("etlmon::Window<{}, {}>", aggregate(m, "Until", "Release"),
                               m.length);
        case Kind::handover_window:
            return fmt::format("etlmon::Window<{}, {}>", aggregate(m, "Handover", "Covered"),
                               m.length);
        case Kind::count_window:
            return fmt::format("etlmon::{}<Value, {}, {}>", m.max ? "AtLeast" : "AllBut", m.count,
                               m.length);
        case Kind::widening:
            return fmt::format("etlmon::Widening<{}, {}, {}>", aggregate(m, "Greatest", "Least"),
                               m.from_length, m.length);
        case Kind::machine: return fmt::format("etlmon::Machine<Value, {}>", m.length);
        case Kind::recent: return fmt::format("etlmon::Recent<Value, {}>", m.length);
        case Kind::pending_machine:
            return fmt::format("etlmon::PendingMachine<Value, {}, {}>", m.length, m.guards);
    }
    return "";
}

std::string reset_of(const Context& context, const plan::Member& member, const std::string& name) {
    const bool is_value = member.kind == Kind::value || member.kind == Kind::variable;
    if (is_value) return fmt::format("{} = {};", name, context.literal(member.first));
    return fmt::format("{}.reset({});", name,
                       member.kind == Kind::delay ? context.literal(member.first) : "");
}

Member declared(const Context& context, const plan::Member& member, const std::string& name,
                const std::string& comment, std::uint32_t begins_with) {
    return {type_of(context, member),        name, comment,
            reset_of(context, member, name), "",   begins_with};
}

/// Adds the members of a reading. Registers in an array are one member.
void add_members(std::vector<Member>& result, const Context& context, std::size_t r) {
    const Names::OfReading& names = context.names.readings[r];
    const std::uint32_t begins_with = context.plan.readings[r].begins_with;
    const std::vector<plan::Member> members = plan::members_of(context.plan.readings[r]);
    for (std::size_t i = 0; i < members.size(); ++i) {
        const std::string& name = names.members[i];
        const bool is_element = i < names.elements.size() && names.elements[i] != plan::kNone;
        if (!is_element) {
            result.push_back(declared(context, members[i], name,
                                      plan::comment_of(members[i], context.graph), begins_with));
        } else if (names.elements[i] == 0) {
            const auto size = std::count(names.members.begin(), names.members.end(), name);
            const auto last = names.members.rend() -
                              std::find(names.members.rbegin(), names.members.rend(), name) - 1;
            result.push_back(
                {context.spelling.kept, fmt::format("{}[{}]", name, size),
                 comment_of_array(context, members[i], members[static_cast<std::size_t>(last)],
                                  size > 2),
                 fmt::format("etlmon::fill({}, {});", name, context.literal(members[i].first)), "",
                 begins_with});
        }
    }
}

std::string past_type(const check::Past& past) {
    using Past = check::Past::Kind;
    switch (past.kind) {
        case Past::ago: return fmt::format("etlmon::Ago<{}>", past.steps);
        case Past::mean: return fmt::format("etlmon::MovingMean<{}>", past.steps);
        case Past::min: return fmt::format("etlmon::MovingMin<{}>", past.steps);
        case Past::max: return fmt::format("etlmon::MovingMax<{}>", past.steps);
        case Past::count:
        case Past::fraction: break;
    }
    return "";
}

}  // namespace

std::string comment_of_array(const Context& context, const plan::Member& first,
                             const plan::Member& last, bool more) {
    plan::Member only_formulas = last;
    only_formulas.before.clear();
    return fmt::format("{}, {}{}", plan::comment_of(first, context.graph), more ? "..., " : "",
                       plan::comment_of(only_formulas, context.graph));
}

std::vector<Member> past_members(const Context& context) {
    std::vector<Member> result;
    for (const auto& [p, name] : context.names.past_member) {
        const check::Past& past = context.model.pasts[p];
        result.push_back(
            {past_type(past), name,
             fmt::format("{} at the last {}", check::print(context.model, past.expression),
                         diag::counted(past.steps, "step")),
             name + ".reset();", ""});
    }
    return result;
}

std::vector<Member> temporal_members(const Context& context) {
    const plan::Plan& plan = context.plan;
    std::vector<Member> result;
    for (std::size_t r = 0; r < plan.readings.size(); ++r) add_members(result, context, r);
    for (plan::Slot slot = 0; slot < plan.streams.size(); ++slot)
        for (const plan::Member& member : plan::members_of(plan.streams[slot]))
            result.push_back(declared(context, member, context.names.streams[slot].member,
                                      plan::text_of(plan.streams[slot], context.graph),
                                      plan.streams[slot].begins_with));
    return result;
}

}  // namespace etlc::emit
