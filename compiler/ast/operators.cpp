#include "ast/operators.hpp"

namespace etlc::ast {

Operator operator_of(Formula::Kind kind) {
    using Kind = Formula::Kind;
    switch (kind) {
        case Kind::constant_true: return {kAtom, "true"};
        case Kind::constant_false: return {kAtom, "false"};
        case Kind::name: return {kAtom, ""};
        case Kind::comparison: return {kComparison, ""};
        case Kind::equivalence: return {kIff, "<->"};
        case Kind::implication: return {kImplies, "->"};
        case Kind::disjunction: return {kOr, "||"};
        case Kind::conjunction: return {kAnd, "&&"};
        case Kind::until: return {kBinary, "U"};
        case Kind::weak_until: return {kBinary, "W"};
        case Kind::release: return {kBinary, "R"};
        case Kind::since: return {kBinary, "S"};
        case Kind::negation: return {kPrefix, "!"};
        case Kind::next: return {kPrefix, "X"};
        case Kind::eventually: return {kPrefix, "F"};
        case Kind::always: return {kPrefix, "G"};
        case Kind::previous: return {kPrefix, "Y"};
        case Kind::once: return {kPrefix, "O"};
        case Kind::historically: return {kPrefix, "H"};
        case Kind::rise: return {kPrefix, "rise"};
        case Kind::fall: return {kPrefix, "fall"};
        case Kind::held: return {kPrefix, "held"};
    }
    return {kAtom, ""};
}

}  // namespace etlc::ast
