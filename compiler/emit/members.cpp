// Declares the members that the plan lists for readings, streams and numbers of earlier steps.
#include <algorithm>

#include "diag/diag.hpp"
#include "emit/context.hpp"

namespace etlc::emit {

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
        case Past::count: break;
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
