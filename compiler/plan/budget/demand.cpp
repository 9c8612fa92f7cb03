#include "plan/budget/demand.hpp"

#include <algorithm>

#include "plan/budget/budget.hpp"
#include "plan/program/program.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::plan {

namespace {

constexpr std::uint64_t kMuch = std::uint64_t{1} << 40U;  // shared parts count once per operand
constexpr std::uint64_t kManyAsks = 16;

bool passes_on(StreamOp op) {
    return op == StreamOp::negation || op == StreamOp::combination || op == StreamOp::within;
}

Demand of_operands(const Stream& stream, const std::vector<Demand>& known, bool is_shared) {
    Demand demand{.asks = 0};
    for (Slot operand : stream.operands) {
        demand.asks += known[operand].keeps ? 1 : known[operand].asks;
        demand.lazy = demand.lazy || known[operand].lazy;
        demand.work = std::min(kMuch, demand.work + known[operand].work);
    }
    if (stream.op == StreamOp::within) demand.asks = 1;  // its value is kept anyway
    demand.keeps = demand.lazy && is_shared && demand.asks > kManyAsks;
    return demand;
}

}  // namespace

bool found_on_demand(const Stream& stream, const std::vector<bool>& known) {
    if (stream.op == StreamOp::predicate || stream.op == StreamOp::flag) return true;
    return passes_on(stream.op) && std::any_of(stream.operands.begin(), stream.operands.end(),
                                               [&](Slot operand) { return known[operand]; });
}

std::vector<Demand> demands(const Plan& plan) {
    std::vector<int> users(plan.streams.size());
    for (const Stream& stream : plan.streams)
        for (Slot operand : stream.operands) ++users[operand];
    std::vector<Demand> result(plan.streams.size());
    if (!value_type(plan.values).on_demand) return result;
    for (Slot slot = 0; slot < plan.streams.size(); ++slot) {  // operands come first
        const Stream& stream = plan.streams[slot];
        if (stream.op == StreamOp::predicate)
            result[slot] = {.lazy = true, .work = measured_elements(*plan.model, stream.index)};
        else if (stream.op == StreamOp::flag)
            result[slot].lazy = true;
        else if (passes_on(stream.op))
            result[slot] = of_operands(stream, result, users[slot] > 1);
    }
    return result;
}

}  // namespace etlc::plan
