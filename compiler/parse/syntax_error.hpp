// Explains an error in one declaration in the user's terms, as a SyntaxError. Parsing stops at a
// declaration's first error.
#pragma once

#include <string>

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

}  // namespace etlc::parse
