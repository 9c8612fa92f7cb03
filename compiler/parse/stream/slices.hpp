// Splits tokens into slices, one for each declaration, which are parsed separately. A slice ends
// with its ';', before a word that begins another declaration, or at EOF. Slices cover all tokens
// but EOF in order, so an error in one cannot affect another.
#pragma once

#include <optional>
#include <vector>

#include "parse/stream/tokens.hpp"

namespace etlc::parse {

struct Slice {
    std::size_t begin;  ///< index of the first token
    std::size_t end;    ///< index after the last token; a token exists there, EOF at the latest
};

std::vector<Slice> slices_of(const Tokens& tokens);

/// Returns the first token that nests deeper than kMaxNesting, before ANTLR's recursive descent
/// gets there. Accepted slices recurse at most kMaxNesting times a grammar rule, here and in every
/// walk over the tree.
std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice);

/// One slice as ANTLR's token stream, with EOF at its end.
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
    // The stream is never asked for text, which the file has.
    std::string getText(const antlr4::misc::Interval& /*interval*/) override { return {}; }
    std::string getText() override { return {}; }
    std::string getText(antlr4::RuleContext* /*context*/) override { return {}; }
    std::string getText(Token* /*start*/, Token* /*stop*/) override { return {}; }

private:
    const Tokens& tokens_;
    Slice slice_;
    std::size_t at_ = 0;  ///< from the beginning of the slice
    antlr4::CommonToken end_;
};

}  // namespace etlc::parse
