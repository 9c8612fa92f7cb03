// How the operators of formulas are written, and how tight they bind.
#pragma once

#include <cstdint>
#include <string_view>

#include "ast/ast.hpp"

namespace etlc::ast {

/// How tight a formula binds, from the loosest.
enum FormulaLevel : std::uint8_t {
    kIff,
    kImplies,
    kOr,
    kAnd,
    kBinary,
    kPrefix,
    kComparison,
    kAtom
};

struct Operator {
    FormulaLevel level;
    std::string_view symbol;
};

Operator operator_of(Formula::Kind kind);

}  // namespace etlc::ast
