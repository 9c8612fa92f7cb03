// Where ANTLR's parser cannot go on.
#pragma once

#include <cstddef>
#include <exception>

#include "EtlParser.h"
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

    bool expects(std::size_t type) const { return expected.contains(type); }

    /// The rule that the parser is in; names have one of their own.
    std::size_t rule_around() const {
        return rule == grammar::EtlParser::RuleName ? parent_rule : rule;
    }

    /// In the declaration of a let, a truth or a monitor.
    bool in_formula() const {
        switch (declaration) {
            case grammar::EtlParser::LET:
            case grammar::EtlParser::TRUTH:
            case grammar::EtlParser::MONITOR:
            case grammar::EtlParser::SLIDING:
            case grammar::EtlParser::RESTARTABLE:
            case grammar::EtlParser::REPEATING: return true;
            default: return false;
        }
    }
};

/// Stops the parser at its first error: ANTLR's own recovery and messages are never used.
class StopAtError : public antlr4::ANTLRErrorStrategy {
public:
    void reset(antlr4::Parser* /*parser*/) override {}
    Token* recoverInline(antlr4::Parser* parser) override {
        stop(parser, parser->getCurrentToken());
        return nullptr;
    }
    void recover(antlr4::Parser* parser, std::exception_ptr error) override {
        try {
            std::rethrow_exception(error);
        } catch (const antlr4::RecognitionException& e) {
            stop(parser, e.getOffendingToken());
        }
    }
    void sync(antlr4::Parser* /*parser*/) override {}
    bool inErrorRecoveryMode(antlr4::Parser* /*parser*/) override { return false; }
    void reportMatch(antlr4::Parser* /*parser*/) override {}
    void reportError(antlr4::Parser* /*parser*/,
                     const antlr4::RecognitionException& /*error*/) override {}

private:
    /// Throws.
    virtual void stop(antlr4::Parser* parser, const Token* found) = 0;
};

}  // namespace etlc::parse
