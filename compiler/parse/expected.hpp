// What could have stood at a place, in words.
// Takes: where the parser is stuck. Gives: "a formula", "':' or ','", "a type (f32, f16[D], ...)",
// and the words near which a misspelling may lie. Keeps true: no word of the grammar's own names
// reaches a user.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "parse/syntax_error.hpp"

namespace etlc::parse {

std::string expected_words(const Stuck& stuck);

/// The place wants one of a closed list of words (types, units, distances), so another word is an
/// unknown keyword.
bool expects_keyword(const Stuck& stuck);

/// The words that could have stood there, for the nearest to a misspelt one.
std::vector<std::string> expected_spellings(const Stuck& stuck);

/// The names of distances.
const std::vector<std::string>& distance_words();

/// "l2, l1 or mahalanobis(M)", of all distances; `before_last`: " or ".
std::string distances_in_words(std::string_view before_last);

/// The names of distances and functions.
const std::vector<std::string>& callable_words();

/// How an operator or reserved word is called: "the operator 'eventually'".
std::string description_of_reserved(std::size_t type);

}  // namespace etlc::parse
