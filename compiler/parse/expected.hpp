// Describes what was expected at a place: "a formula", "':' or ','", "a type (f32, f16[D], ...)".
// Names of grammar rules never reach a user.
#pragma once

#include <string>
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

/// Returns how distances are written: "l2", "mahalanobis(M)".
std::vector<std::string> distance_forms();

/// Describes an operator or a reserved word: "the operator 'eventually'".
std::string description_of_reserved(std::size_t type);

}  // namespace etlc::parse
