#include "emit/context.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "plan/program/value_type.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"

namespace etlc::emit {

namespace {

using plan::StreamOp;

std::string without_blanks(std::string text) {
    std::erase(text, ' ');
    return text;
}

}  // namespace

std::string open_condition(ir::Interval interval, std::string_view position) {
    if (interval.low == interval.high) return fmt::format("{} == {}", position, interval.low);
    std::string text;
    if (interval.low > 0) text = fmt::format("{} >= {}", position, interval.low);
    if (interval.bounded())
        text += fmt::format("{}{} <= {}", text.empty() ? "" : " && ", position, interval.high);
    return text;
}

std::string call(std::string_view function, const std::vector<std::string>& arguments, bool lazy) {
    if (arguments.size() == 1) return arguments.front();
    if (!lazy) return fmt::format("{}({})", function, fmt::join(arguments, ", "));
    std::string text = arguments.front();
    for (std::size_t i = 1; i < arguments.size(); ++i)
        text = fmt::format("{}({}, {})", function, text, arguments[i]);
    return text;
}

bool Context::enclosed(check::Index distance) const {
    const plan::NarrowSet* set = plan::narrow_set(plan, distance);
    return set != nullptr && !set->lossless;
}

bool Context::lossless(check::Index distance) const {
    return plan::narrow_set(plan, distance) != nullptr && !enclosed(distance);
}

std::string Context::literal(plan::Key key) const {
    if (key == etlmon::kTop) return spelling.top;
    if (key == etlmon::kBottom) return spelling.bottom;
    return fmt::format("etlmon::key_of({})", float_literal(etlmon::float_of(key)));
}

bool Context::has_two_thresholds() const {
    return std::any_of(plan.predicates.begin(), plan.predicates.end(), [&](check::Index p) {
        return model.predicates[p].threshold.inner.has_value();
    });
}

std::string Context::bound(plan::Key key) const {
    const auto end = ends.find(key);
    return end == ends.end() || end->second.empty() ? literal(key) : end->second;
}

std::map<plan::Key, std::string> unseen_ends(const plan::Plan& plan, const Names& names) {
    std::map<plan::Key, std::string> ends;
    const auto add = [&](plan::Key key, const std::string& text) {
        if (key == etlmon::kTop || key == etlmon::kBottom) return;
        const auto [entry, added] = ends.try_emplace(key, text);
        if (!added) entry->second.clear();
    };
    for (const auto& [p, name] : names.predicate_unseen) {
        const auto [low, high] = plan::unseen_range(plan.model->predicates[p], plan.values);
        add(low, name + "().low");
        if (high != low) add(high, name + "().high");
        if (high != -low) {  // negated
            add(-high, fmt::format("-{}().high", name));
            if (high != low) add(-low, fmt::format("-{}().low", name));
        }
    }
    return ends;
}

std::string_view Context::step_qualifier() const {
    constexpr std::uint64_t kFewOperations = 256;
    const bool small = plan.cost.distance_operations == 0 &&
                       plan.cost.operations <= kFewOperations && !plan.recorder;
    return small ? "ETLMON_INLINE " : "";
}

std::string Context::literal(plan::Value value) const {
    if (value.low == value.high && value.low == etlmon::kTop) return spelling.yes;
    if (value.low == value.high && value.low == etlmon::kBottom) return spelling.no;
    if (!spelling.neither.empty()) return spelling.neither;
    return fmt::format("Value{{{}, {}}}", literal(value.low), literal(value.high));
}

std::string Context::atom_literal(plan::Value value) const {
    if (!explains) return literal(value);
    if (value.low == value.high && value.low == etlmon::kTop) return "etlmon::kTrue";
    if (value.low == value.high && value.low == etlmon::kBottom) return "etlmon::kFalse";
    return fmt::format("{}{{{}, {}}}", spelling.atom, literal(value.low), literal(value.high));
}

std::vector<plan::Slot> Context::by_work(std::vector<plan::Slot> slots) const {
    std::stable_sort(slots.begin(), slots.end(),
                     [&](plan::Slot a, plan::Slot b) { return work(a) < work(b); });
    return slots;
}

std::string Context::value(plan::Slot slot) const {
    const plan::Stream& stream = plan.streams[slot];
    const std::string now = on_demand ? "" : "now.";
    if (stream.op == StreamOp::constant) return literal(stream.value);
    const bool is_predicate = stream.op == StreamOp::predicate;
    if (is_predicate || stream.op == StreamOp::flag)
        return now + (is_predicate ? names.predicate_atom : names.flag_atom).at(stream.index);
    const bool is_register = stream.op == StreamOp::running || stream.op == StreamOp::since;
    return is_register ? names.streams[slot].member : local(slot);
}

std::string Context::local(plan::Slot slot) const {
    const std::vector<plan::Slot>& shared = parts.shared_streams;
    return (std::binary_search(shared.begin(), shared.end(), slot) ? "shared." : "") +
           names.streams[slot].local;
}

std::string Context::reading(std::uint32_t index) const {
    const std::vector<std::uint32_t>& shared = parts.shared_readings;
    return (std::binary_search(shared.begin(), shared.end(), index) ? "shared." : "") +
           names.readings[index].local;
}

std::string Context::low(plan::Slot slot) const {
    const plan::Stream& stream = plan.streams[slot];
    return stream.op == StreamOp::constant ? bound(stream.value.low) : value(slot) + ".low";
}

std::string Context::high(plan::Slot slot) const {
    const plan::Stream& stream = plan.streams[slot];
    return stream.op == StreamOp::constant ? bound(stream.value.high) : value(slot) + ".high";
}

std::string reading_declaration(const Context& context, std::uint32_t reading) {
    const bool declared = context.on_demand && context.plan.readings[reading].operands.empty() &&
                          !open_monitors(context, context.dependents.of_reading[reading]).empty();
    const std::string name = context.reading(reading);
    return (declared || name != context.names.readings[reading].local ? "" : "const Reading ") +
           name;
}

std::string open_monitors(const Context& context, const std::vector<std::size_t>& monitors) {
    std::string text;
    for (std::size_t m : monitors) {
        const auto open = context.names.open_local.find(m);
        if (open == context.names.open_local.end()) return "";
        text += (text.empty() ? "" : " || ") + open->second;
    }
    return text;
}

const std::string& Context::position(std::uint32_t begins_with) const {
    static const std::string kOfTrace = "position_";
    return begins_with == plan::kNone ? kOfTrace : names.position_member.at(begins_with);
}

std::string Context::place(source::Span span) const {
    return fmt::format("{}:{}: {}", spec_file, model.file.position(span.begin).line,
                       quoted(model.file.text(span)));
}

std::string Context::place(plan::NodeId node) const {
    const std::string text = graph.text(node);
    const source::Span span = graph[node].span;
    const std::string words = place(span);
    const bool as_written =
        span == source::Span{} || without_blanks(words).ends_with(without_blanks(quoted(text)));
    return as_written ? words : fmt::format("{}  ({})", words, quoted(text));
}

}  // namespace etlc::emit
