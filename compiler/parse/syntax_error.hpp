// What stops the reading of one declaration.
// Takes: the place where ANTLR's parser is stuck. Gives: one diagnostic in the user's terms, thrown
// as SyntaxError. Keeps true: parsing stops at a declaration's first error; ANTLR's own recovery
// and messages are never used.
#pragma once

#include <string>

#include "diag/diag.hpp"
#include "parse/stream/stuck.hpp"

namespace etlc::parse {

struct SyntaxError {
    diag::Diagnostic diagnostic;
    /// The words at the place: an error that only follows from a reserved word used as a name is
    /// told by them.
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

/// `next`: the first token after the slice, which is what the user sees where the slice ended too
/// early.
SyntaxError explain(const Stuck& stuck, const Token& next, const source::File& file);

}  // namespace etlc::parse
