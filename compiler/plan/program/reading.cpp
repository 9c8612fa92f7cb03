#include "plan/program/reading.hpp"

#include <algorithm>

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

}  // namespace etlc::plan
