// What a step computes of a reading: minima and maxima over streams, registers and constants.
// Takes: operands. Gives: a tree of six kinds, which emit/ prints and the evaluator computes. Keeps
// true: a neutral constant is dropped, an absorbing one stands alone, and no max is the operand of
// a max; so two ways to say the same bound are mostly one term.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/temporal/value.hpp"

namespace etlc::plan {

using check::Index;
using check::kNone;
using check::kUnbounded;
using etlmon::Key;
using etlmon::Value;
using Slot = std::uint32_t;  ///< index of a stream

/// The max of nothing; of a dual, whose max is a min, the min of nothing.
constexpr Value neutral(bool max) {
    return max ? etlmon::kFalse : etlmon::kTrue;
}

/// Which part of a value is meant: a lower bound is a low end, an upper bound a high one.
enum class End : std::uint8_t { both, low, high };

struct Term {
    enum class Kind : std::uint8_t {
        constant,  ///< `value`
        stream,    ///< of this slot
        reg,       ///< a register of the reading
        local,     ///< what an earlier assignment of this step has computed
        extreme,   ///< the max or min of two operands or more
        before,    ///< the first operand before position `index`, from there on the second
    };
    Kind kind = Kind::constant;
    bool max = true;  ///< of an extreme; else the min
    std::uint32_t index = 0;
    Value value{};
    std::vector<Term> operands;

    static Term constant(Value value);
    static Term stream(Slot slot);
    static Term reg(std::size_t index);
    static Term local(std::size_t index);
    /// Of any number of terms.
    static Term extreme(bool max, std::vector<Term> operands);
    static Term before(std::uint32_t position, Term inside, Term after);
};

bool operator==(const Term& a, const Term& b);

/// Minima and maxima of two that computing it takes.
std::size_t combinations(const Term& term);
/// The position of the step is looked at.
bool asks_position(const Term& term);

/// Calls visit(slot) for every stream that is read; of a term that may be changed, with a slot that
/// may be.
template <class T, class Visit>
void for_each_slot_of(T& term, const Visit& visit) {
    if (term.kind == Term::Kind::stream) visit(term.index);
    for (auto& operand : term.operands) for_each_slot_of(operand, visit);
}

}  // namespace etlc::plan
