// Describes what was expected at a place: "a formula", "':' or ','", "a type (f32, f16[D], ...)".
// Names of grammar rules never reach a user.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "parse/syntax_error.hpp"

namespace etlc::parse {

std::string expected_words(const Stuck& stuck);

/// Whether the place accepts only a closed list of words (types, units, distances), so that another
/// word is an unknown keyword.
bool expects_keyword(const Stuck& stuck);

/// Returns the accepted words, to find the one nearest to a misspelling.
std::vector<std::string> expected_spellings(const Stuck& stuck);

/// Returns the names of distances.
const std::vector<std::string>& distance_words();

/// Lists all distances, "l2, l1 or mahalanobis(M)" for the separator " or " before the last.
std::string distances_in_words(std::string_view before_last);

/// Returns the names of distances and functions.
const std::vector<std::string>& callable_words();

/// Describes an operator or a reserved word: "the operator 'eventually'".
std::string description_of_reserved(std::size_t type);

}  // namespace etlc::parse
