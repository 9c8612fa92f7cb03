// Negation normal form: the formulas of the monitors with negation on literals only.
// Takes: the formulas of the model. Gives: nodes over fewer operators, each with its dual beside
// it. Keeps true: a node's operands have smaller indices than the node; equal (formula, polarity)
// pairs are one node.
#pragma once

#include <cstdint>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::reference {

using check::Index;

struct Node {
    enum class Kind : std::uint8_t {
        constant,    ///< true, or false where negated
        predicate,   ///< predicate `index`, or its negation
        boolean,     ///< bool input `index`, or its negation
        all,         ///< && of the operands
        any,         ///< || of the operands
        eventually,  ///< F[low, high]; X is F[1, 1]
        always,      ///< G[low, high]
        until,       ///< operands f, g
        release,     ///< operands f, g
        once,        ///< O[low, high]; Y is O[1, 1]
        historically,
        since,    ///< operands f, g
        trigger,  ///< the dual of since: f T g is !(!f S !g)
    };
    Kind kind = Kind::constant;
    bool negated = false;  ///< of a constant or literal
    Index index = 0;
    std::vector<Index> operands;
    std::uint32_t low = 0;
    std::uint32_t high = check::kUnbounded;

    bool is_atom() const { return kind == Kind::predicate || kind == Kind::boolean; }
    bool connects() const { return kind == Kind::all || kind == Kind::any; }
};

struct NormalForm {
    std::vector<Node> nodes;   ///< those that some monitor reaches, no others
    std::vector<Index> roots;  ///< per monitor
};

NormalForm normal_form(const check::Model& model);

/// The sum of the upper bounds along the deepest path of a formula as written; past operators add
/// nothing.
std::uint64_t horizon(const check::Model& model, Index formula);

}  // namespace etlc::reference
