#include "plan/program/stream.hpp"

#include <fmt/format.h>

namespace etlc::plan {

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

}  // namespace etlc::plan
