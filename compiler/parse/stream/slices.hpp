// Tokens to declarations, each a slice that is parsed by itself.
// Takes: all tokens of a file. Gives: slices, each ended by its ';', by a word that begins another
// declaration, or by EOF. Keeps true: the slices cover all tokens but EOF in order, so an error in
// one cannot reach another.
#pragma once

#include <optional>
#include <vector>

#include "parse/stream/tokens.hpp"

namespace etlc::parse {

struct Slice {
    std::size_t begin;  ///< index of its first token
    std::size_t end;    ///< one past its last; there is always a token there, EOF at the latest
};

std::vector<Slice> slices_of(const Tokens& tokens);

/// The first token of a slice that nests deeper than kMaxNesting, so that ANTLR's recursive descent
/// never goes there: what is let through recurses at most kMaxNesting times a grammar rule, in
/// parse/ and in all that walk trees.
std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice);

/// One slice as ANTLR's token stream. Reads as EOF past the slice's end.
class SliceStream final : public antlr4::TokenStream {
public:
    SliceStream(const Tokens& tokens, Slice slice);

    Token* LT(ssize_t k) override;
    std::size_t LA(ssize_t i) override { return LT(i)->getType(); }
    Token* get(std::size_t index) const override;
    void consume() override;
    ssize_t mark() override { return 0; }
    void release(ssize_t /*marker*/) override {}
    std::size_t index() override { return at_; }
    void seek(std::size_t index) override;
    std::size_t size() override { return slice_.end - slice_.begin; }

    antlr4::TokenSource* getTokenSource() const override {
        return tokens_[slice_.begin]->getTokenSource();
    }
    std::string getSourceName() const override { return {}; }
    // Nobody asks the stream for text: it is the file's.
    std::string getText(const antlr4::misc::Interval& /*interval*/) override { return {}; }
    std::string getText() override { return {}; }
    std::string getText(antlr4::RuleContext* /*context*/) override { return {}; }
    std::string getText(Token* /*start*/, Token* /*stop*/) override { return {}; }

private:
    const Tokens& tokens_;
    Slice slice_;
    std::size_t at_ = 0;  ///< from the slice's begin
    antlr4::CommonToken end_;
};

}  // namespace etlc::parse
