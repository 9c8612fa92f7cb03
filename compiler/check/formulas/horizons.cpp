#include "check/formulas/horizons.hpp"

#include <algorithm>

#include "check/formulas/formulas.hpp"

namespace etlc::check {

namespace {

constexpr std::uint64_t kSaturated = std::uint64_t{1} << 60U;

void take_first(Index& mine, Index operands) {
    if (mine == kNone) mine = operands;
}

}  // namespace

std::vector<Reach> reaches(const Model& model) {
    std::vector<Reach> result(model.formulas.size());
    for (Index i = 0; i < model.formulas.size(); ++i) {
        const Formula& formula = model.formulas[i];
        Reach& reach = result[i];
        if (looks_ahead(formula.kind)) {
            reach.future = i;
            if (formula.high == kUnbounded) reach.unbounded = i;
        }
        for (const Index operand : formula.operands) {
            const Reach& below = result[operand];
            reach.horizon = std::max(reach.horizon, below.horizon);
            if (looks_back(formula.kind) && below.future != kNone)
                take_first(reach.past_over_future, i);
            take_first(reach.future, below.future);
            take_first(reach.unbounded, below.unbounded);
            take_first(reach.past_over_future, below.past_over_future);
        }
        if (looks_ahead(formula.kind) && formula.high != kUnbounded)
            reach.horizon = std::min(kSaturated, reach.horizon + formula.high);
    }
    return result;
}

}  // namespace etlc::check
