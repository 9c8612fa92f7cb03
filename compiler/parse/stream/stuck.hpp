// The state of ANTLR's parser where it cannot go on.
#pragma once

#include <cstddef>
#include <exception>

#include "EtlParser.h"
#include "parse/stream/tokens.hpp"

namespace etlc::parse {

struct Stuck {
    const Token* found;            ///< EOF if the slice ended
    const Token* previous;         ///< nullptr if nothing was read yet
    const Token* before_previous;  ///< nullptr if there is none
    const Token* following;        ///< after `found`; nullptr at the end of the slice
    antlr4::misc::IntervalSet expected;
    std::size_t rule;         ///< EtlParser::Rule...
    std::size_t parent_rule;  ///< of the calling rule
    std::size_t declaration;  ///< type of the first token in the slice
    bool looked_ahead;        ///< `found` lies after the token at which the parser had to decide

    bool expects(std::size_t type) const { return expected.contains(type); }

    /// Returns the rule that the parser is in, or the one around a name.
    std::size_t rule_around() const {
        return rule == grammar::EtlParser::RuleName ? parent_rule : rule;
    }

    /// Whether the place is in the declaration of a let, a truth or a monitor.
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

/// Stops the parser at its first error; ANTLR's own recovery and messages are never used.
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
