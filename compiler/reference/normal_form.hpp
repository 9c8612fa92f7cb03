// The formulas of the monitors in negation normal form. Operands have smaller indices than their
// node; equal (formula, polarity) pairs are one node.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::reference {

using check::Index;

struct Node {
    enum class Kind : std::uint8_t {
        constant,    ///< true
        predicate,   ///< predicate `index`
        boolean,     ///< bool input `index`
        any,         ///< || of the operands; its dual is &&
        eventually,  ///< F[low, high]; X is F[1, 1]; its dual is G
        until,       ///< operands f, g; its dual is R
        once,        ///< O[low, high]; Y is O[1, 1]; its dual is H
        since,       ///< operands f, g; its dual is !(!f S !g)
        at_least,    ///< at `index` or more positions of [0, high]; its dual is !(... of !f)
    };
    Kind kind = Kind::constant;
    bool negated = false;  ///< the negation of a constant or atom, the dual of an operator
    Index index = 0;
    std::vector<Index> operands;
    std::uint32_t low = 0;
    std::uint32_t high = check::kUnbounded;

    bool is_atom() const { return kind == Kind::predicate || kind == Kind::boolean; }
};

struct NormalForm {
    std::vector<Node> nodes;   ///< only those that a monitor reaches
    std::vector<Index> roots;  ///< per monitor
};

NormalForm normal_form(const check::Model& model);

/// Returns the sum of the upper bounds along the deepest path of a formula as written; past
/// operators add nothing.
std::uint64_t horizon(const check::Model& model, Index formula);

}  // namespace etlc::reference
