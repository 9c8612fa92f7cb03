#include "plan/program/members.hpp"

#include <fmt/format.h>

#include "etlmon/hosted/footprint.hpp"

namespace etlc::plan {

namespace {

using Kind = Member::Kind;

/// What a value type takes to keep: a row a type.
struct Footprint {
    std::uint64_t value;
    std::uint32_t (*delay)(std::uint32_t length);
    std::uint32_t (*window)(std::uint32_t length);
    std::uint32_t (*since)(std::uint32_t length);
    std::uint32_t (*until)(std::uint32_t length);
};

template <class V>
constexpr Footprint footprint() {
    return {sizeof(V), etlmon::delay_bytes<V>, etlmon::window_bytes<etlmon::Greatest<V>>,
            etlmon::window_bytes<etlmon::Since<V>>, etlmon::window_bytes<etlmon::Until<V>>};
}

const Footprint& footprint_of(check::Values values) {
    static constexpr Footprint kRobustness = footprint<Value>();
    static constexpr Footprint kTruth = footprint<etlmon::Truth>();
    return values == check::Values::boolean ? kTruth : kRobustness;
}

std::uint64_t in_storage(std::uint64_t bytes) {
    return etlmon::storage_bytes(static_cast<std::uint32_t>(bytes));
}

Member of_formula(Kind kind, NodeId node, std::string after = "") {
    return {.kind = kind, .formulas = {node}, .after = std::move(after)};
}

Member value(bool max, NodeId node, std::string after = "") {
    Member member = of_formula(Kind::value, node, std::move(after));
    member.first = neutral(max);
    return member;
}

Member guard(bool max, std::string words) {
    return {.first = neutral(!max), .before = std::move(words)};
}

/// A register a state that is not always true.
std::vector<Member> registers(const Machine& machine) {
    std::vector<Member> result;
    for (std::size_t q = 0; q < machine.states.size(); ++q) {
        if (machine.states[q].always_true) continue;
        const std::vector<NodeId>& owed = machine.automaton.states[q];
        result.push_back({.first = neutral(q != 0),
                          .before = owed.empty() ? "nothing is owed any more" : "owed: ",
                          .formulas = owed});
    }
    return result;
}

std::vector<Member> pending_members(const Pending& pending, NodeId node) {
    std::vector<Member> result;
    for (const Pending::Part& part : pending.parts) {
        if (part.leaf == kNone) continue;
        result.push_back(of_formula(Kind::recent, part.node));
        result.back().length = pending.horizon + 1;
    }
    if (pending.is_fold) {
        result.push_back(value(pending.fold.max, node, ", where it is settled"));
        result.push_back(guard(pending.fold.max, "what its left side lets through there"));
        result.back().kind = result[result.size() - 2].kind = Kind::variable;
        return result;
    }
    result.push_back(of_formula(Kind::pending_machine, node));
    result.back().length = static_cast<std::uint32_t>(pending.machine.states.size());
    result.back().guards = static_cast<std::uint32_t>(pending.guards.size());
    return result;
}

}  // namespace

std::vector<Member> members_of(const Stream& stream) {
    Member member{.max = stream.max,
                  .length = stream.length,
                  .from_length = stream.from_length,
                  .first = stream.value};
    const bool is_operand = stream.length == 1;  // a window of one position is what it looks at
    switch (stream.op) {
        case StreamOp::constant:
        case StreamOp::predicate:
        case StreamOp::flag:
        case StreamOp::negation:
        case StreamOp::combination:
        case StreamOp::within: return {};
        case StreamOp::delay:
            member.kind = Kind::delay;
            member.first = etlmon::kFalse;
            return {member};
        case StreamOp::shift: member.kind = Kind::delay; return {member};
        case StreamOp::running: member.first = neutral(stream.max); return {member};
        case StreamOp::since: return {member};
        case StreamOp::widening: member.kind = Kind::widening; return {member};
        case StreamOp::window: member.kind = Kind::window; break;
        case StreamOp::window_since: member.kind = Kind::since_window; break;
        case StreamOp::window_until: member.kind = Kind::until_window; break;
    }
    if (is_operand) return {};
    return {member};
}

std::vector<Member> members_of(const Reading& reading) {
    switch (reading.kind) {
        case Reading::Kind::latch: return {value(true, reading.node)};
        case Reading::Kind::fold: {
            std::vector<Member> result{value(reading.fold.max, reading.node)};
            if (reading.fold.left != kNone)
                result.push_back(guard(reading.fold.max, "what its left side lets through"));
            return result;
        }
        case Reading::Kind::response:
            return {value(!reading.response.of_always, reading.node,
                          ": where the answer's time is over")};
        case Reading::Kind::machine: {
            if (reading.machine.unrolled) return registers(reading.machine);
            Member table = of_formula(Kind::machine, reading.node);
            table.length = static_cast<std::uint32_t>(reading.machine.states.size());
            return {table};
        }
        case Reading::Kind::pending: return pending_members(reading.pending, reading.node);
        case Reading::Kind::combination: break;
    }
    return {};
}

std::uint64_t bytes_of(const Member& member, check::Values values) {
    const Footprint& of = footprint_of(values);
    switch (member.kind) {
        case Kind::value:
        case Kind::variable: return of.value;
        case Kind::delay: return of.delay(member.length);
        case Kind::window: return of.window(member.length);
        case Kind::since_window: return of.since(member.length);
        case Kind::until_window: return of.until(member.length);
        case Kind::widening: return of.delay(member.length - member.from_length);
        case Kind::machine: return in_storage(2 * member.length * of.value);
        case Kind::recent: return in_storage(member.length * of.value);
        case Kind::pending_machine: return member.length * of.value;
    }
    return 0;
}

std::string comment_of(const Member& member, const ir::Graph& formulas) {
    std::string text = member.before;
    for (std::size_t i = 0; i < member.formulas.size(); ++i)
        text += (i == 0 ? "" : ", ") + formulas.text(member.formulas[i]);
    return text + member.after;
}

std::string text_of(const Stream& stream, const ir::Graph& formulas) {
    if (stream.node != kNone) return formulas.text(stream.node);
    switch (stream.op) {
        case StreamOp::since: return "what is asked and not yet answered";
        case StreamOp::window:
        case StreamOp::window_since:
        case StreamOp::window_until:
        case StreamOp::widening:
            return fmt::format("the {} over the last {} steps", stream.max ? "max" : "min",
                               stream.length);
        default: return "";
    }
}

}  // namespace etlc::plan
