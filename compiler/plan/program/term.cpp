#include "plan/program/term.hpp"

#include <algorithm>

namespace etlc::plan {

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

}  // namespace etlc::plan
