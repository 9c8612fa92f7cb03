// Where ANTLR's parser cannot go on.
#pragma once

#include <cstddef>

#include "parse/stream/slices.hpp"

namespace etlc::parse {

/// A parser that cannot go on, and what it would have taken.
struct Stuck {
    const Token* found;            ///< EOF where the slice ended
    const Token* previous;         ///< nullptr: nothing read yet
    const Token* before_previous;  ///< nullptr: no such token
    const Token* following;        ///< after `found`; nullptr: the slice ends
    antlr4::misc::IntervalSet expected;
    std::size_t rule;         ///< EtlParser::Rule...
    std::size_t parent_rule;  ///< of the rule that called it
    std::size_t declaration;  ///< type of the slice's first token
    bool looked_ahead;        ///< found lies past the token at which the parser had to decide
    const antlr4::dfa::Vocabulary* vocabulary;
};

}  // namespace etlc::parse
