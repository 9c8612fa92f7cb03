// Terms: minima and maxima over streams, registers and constants, which readings compute at every
// step. Neutral constants are dropped, absorbing ones replace the whole, and no max is an operand
// of a max, so equal bounds mostly are equal terms.
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

/// Returns the max of nothing; for a dual, whose max is a min, the min of nothing.
constexpr Value neutral(bool max) {
    return max ? etlmon::kFalse : etlmon::kTrue;
}

/// The end of a value that counts: the low end for a lower bound, the high end for an upper bound.
enum class End : std::uint8_t { both, low, high };

struct Term {
    enum class Kind : std::uint8_t {
        constant,  ///< `value`
        stream,    ///< of this slot
        reg,       ///< a register of the reading
        local,     ///< the result of an earlier assignment of this step
        extreme,   ///< the max or min of at least two operands
        before,    ///< the first operand before position `index`, then the second
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
    /// Returns the extreme of any number of terms.
    static Term extreme(bool max, std::vector<Term> operands);
    static Term before(std::uint32_t position, Term inside, Term after);
};

bool operator==(const Term& a, const Term& b);

/// Returns the number of binary minima and maxima of a term.
std::size_t combinations(const Term& term);
/// Returns whether the term reads the position of the step.
bool asks_position(const Term& term);

/// Calls visit(slot) for every stream that is read; the slot of a mutable term is mutable.
template <class T, class Visit>
void for_each_slot_of(T& term, const Visit& visit) {
    if (term.kind == Term::Kind::stream) visit(term.index);
    for (auto& operand : term.operands) for_each_slot_of(operand, visit);
}

}  // namespace etlc::plan
