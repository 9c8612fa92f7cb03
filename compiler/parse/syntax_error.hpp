// Explains an error in one declaration in the user's terms, as a SyntaxError. Parsing stops at a
// declaration's first error.
#pragma once

#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "parse/stream/stuck.hpp"

namespace etlc::parse {

struct SyntaxError {
    diag::Diagnostic diagnostic;
    /// The words at the place; they identify errors that only follow from a reserved word used as a
    /// name.
    std::string found{};
    std::string previous{};
};

class Strategy final : public StopAtError {
public:
    Strategy(const source::File& file, const Tokens& tokens, Slice slice)
        : file_(file), tokens_(tokens), slice_(slice) {}

private:
    void stop(antlr4::Parser* parser, const Token* found) override;

    const source::File& file_;
    const Tokens& tokens_;
    Slice slice_;
};

/// `next` is the first token after the slice, which the user sees where the slice ended too early.
SyntaxError explain(const Stuck& stuck, const Token& next, const source::File& file);

/// Describes what was expected at a place: "a formula", "':' or ','", "a type (f32, f16[D], ...)".
/// Names of grammar rules never reach a user.
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
