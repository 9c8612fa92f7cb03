#include "plan/program/members.hpp"

#include "etlmon/hosted/footprint.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::plan {

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
