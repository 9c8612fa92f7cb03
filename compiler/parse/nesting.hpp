// How deep a declaration nests, before ANTLR's recursive descent goes there.
// Takes: the tokens of one slice, in one pass. Gives: the first token that nests deeper than
// kMaxNesting. Keeps true: what it lets through recurses at most kMaxNesting times a grammar rule,
// in parse/ and in all that walk trees.
#pragma once

#include <optional>

#include "parse/stream/slices.hpp"

namespace etlc::parse {

std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice);

}  // namespace etlc::parse
