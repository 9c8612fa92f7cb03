#include "plan/program/reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "etlmon/hosted/footprint.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::plan {

namespace {

std::uint32_t count(const auto& list) {
    return static_cast<std::uint32_t>(list.size());
}

/// Returns the members of the last positions, then those of the settled ones.
std::vector<Member> members_of(const Pending& pending, NodeId node) {
    std::vector<Member> result;
    for (const Pending::Part& part : pending.parts)
        if (part.leaf != kNone)
            result.push_back({.kind = Member::Kind::recent,
                              .length = pending.horizon + 1,
                              .formulas = {part.node}});
    if (pending.is_fold) {
        result.push_back({.kind = Member::Kind::variable,
                          .first = neutral(pending.fold.max),
                          .formulas = {node},
                          .after = ", where it is settled"});
        result.push_back({.kind = Member::Kind::variable,
                          .first = neutral(!pending.fold.max),
                          .suffix = "_guard",
                          .before = "what its left side lets through there"});
        return result;
    }
    result.push_back({.kind = Member::Kind::pending_machine,
                      .length = count(pending.table.ends),
                      .guards = count(pending.table.guards),
                      .formulas = {node}});
    return result;
}

}  // namespace

std::vector<Member> members_of(const Reading& reading) {
    switch (reading.kind) {
        case Reading::Kind::straight: return reading.straight.registers;
        case Reading::Kind::table:
            return {{.kind = Member::Kind::machine,
                     .length = count(reading.table.ends),
                     .formulas = {reading.node}}};
        case Reading::Kind::pending: return members_of(reading.pending, reading.node);
        case Reading::Kind::combination: break;
    }
    return {};
}

bool asks_position(const Reading& reading) {
    if (reading.kind != Reading::Kind::straight) return reading.kind == Reading::Kind::pending;
    const Straight& code = reading.straight;
    return asks_position(code.lower) || asks_position(code.upper) ||
           std::any_of(code.assignments.begin(), code.assignments.end(),
                       [](const Assignment& a) { return a.positions != ir::Interval{}; });
}

const Table* table_of(const Reading& reading) {
    if (reading.kind == Reading::Kind::table) return &reading.table;
    const bool has_table = reading.kind == Reading::Kind::pending && !reading.pending.is_fold;
    return has_table ? &reading.pending.table : nullptr;
}

using Kind = Member::Kind;

std::vector<Member> members_of(const Stream& stream) {
    Member member{.max = stream.max,
                  .length = stream.length,
                  .from_length = stream.from_length,
                  .first = stream.value};
    const bool is_operand = stream.length == 1;  // a window of one position is its operand
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
        case StreamOp::window_count:
            member.kind = Kind::count_window;
            member.count = stream.index;
            return {member};
        case StreamOp::window_since: member.kind = Kind::since_window; break;
        case StreamOp::window_until: member.kind = Kind::until_window; break;
        case StreamOp::window_handover: member.kind = Kind::handover_window; break;
    }
    if (is_operand) return {};
    return {member};
}

std::string text_of(const Stream& stream, const ir::Graph& formulas) {
    if (stream.node != kNone) return formulas.text(stream.node);
    if (!stream.holds.empty()) return std::string(stream.holds);
    switch (stream.op) {
        case StreamOp::since: return "what is asked and not yet answered";
        case StreamOp::window:
        case StreamOp::window_since:
        case StreamOp::window_until:
        case StreamOp::window_handover:
        case StreamOp::widening:
            return fmt::format("the {} over the last {} steps", stream.max ? "max" : "min",
                               stream.length);
        default: return "";
    }
}

namespace {

bool is_constant(const Term& term, Value value) {
    return term.kind == Term::Kind::constant && term.value.low == value.low &&
           term.value.high == value.high;
}

}  // namespace

bool operator==(const Term& a, const Term& b) {
    if (a.kind != b.kind || a.index != b.index || a.operands != b.operands) return false;
    if (a.kind == Term::Kind::constant) return is_constant(b, a.value);
    return a.kind != Term::Kind::extreme || a.max == b.max;
}

Term Term::constant(Value value) {
    return {.kind = Kind::constant, .value = value};
}

Term Term::stream(Slot slot) {
    return {.kind = Kind::stream, .index = slot};
}

Term Term::reg(std::size_t index) {
    return {.kind = Kind::reg, .index = static_cast<std::uint32_t>(index)};
}

Term Term::local(std::size_t index) {
    return {.kind = Kind::local, .index = static_cast<std::uint32_t>(index)};
}

Term Term::extreme(bool max, std::vector<Term> operands) {
    std::vector<Term> kept;
    for (Term& operand : operands) {
        if (is_constant(operand, neutral(!max))) return operand;
        if (is_constant(operand, neutral(max))) continue;
        const bool nested = operand.kind == Kind::extreme && operand.max == max;
        if (nested)
            kept.insert(kept.end(), operand.operands.begin(), operand.operands.end());
        else
            kept.push_back(std::move(operand));
    }
    const auto varies = [](const Term& term) { return term.kind != Kind::constant; };
    std::stable_partition(kept.begin(), kept.end(), varies);  // for people: max(v, 0.2)
    if (kept.empty()) return constant(neutral(max));
    if (kept.size() == 1) return kept.front();
    return {.kind = Kind::extreme, .max = max, .operands = std::move(kept)};
}

Term Term::before(std::uint32_t position, Term inside, Term after) {
    if (position == kUnbounded || inside == after) return inside;
    return {
        .kind = Kind::before, .index = position, .operands = {std::move(inside), std::move(after)}};
}

std::size_t combinations(const Term& term) {
    std::size_t count = term.kind == Term::Kind::extreme ? term.operands.size() - 1 : 0;
    for (const Term& operand : term.operands) count += combinations(operand);
    return count;
}

bool asks_position(const Term& term) {
    return term.kind == Term::Kind::before ||
           std::any_of(term.operands.begin(), term.operands.end(),
                       [](const Term& operand) { return asks_position(operand); });
}

namespace {

using Kind = Member::Kind;

std::uint64_t in_storage(std::uint64_t bytes) {
    return etlmon::storage_bytes(static_cast<std::uint32_t>(bytes));
}

}  // namespace

std::uint64_t bytes_of(const Member& member, check::Values values) {
    const ValueType& of = value_type(values);
    switch (member.kind) {
        case Kind::value:
        case Kind::variable: return of.value;
        case Kind::delay: return of.delay(member.length);
        case Kind::window: return of.window(member.length);
        case Kind::since_window: return of.since(member.length);
        case Kind::until_window: return of.until(member.length);
        case Kind::handover_window: return of.handover(member.length);
        case Kind::count_window: return of.count(member.count, member.length);
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

}  // namespace etlc::plan
