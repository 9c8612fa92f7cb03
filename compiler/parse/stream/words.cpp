#include "parse/stream/words.hpp"

#include "EtlLexer.h"
#include "parse/stream/tokens.hpp"

namespace etlc::parse {

using grammar::EtlLexer;

namespace {

Word::Kind kind_of(const Token& token, const source::File& file) {
    if (is_mistake(token)) return Word::Kind::mistake;
    if (is_reserved_word(token, file)) return Word::Kind::reserved;
    if (token.getType() == EtlLexer::IDENTIFIER) return Word::Kind::name;
    if (is_name(token)) return Word::Kind::contextual;
    if (token.getType() == EtlLexer::NUMBER) return Word::Kind::number;
    return token.getType() == EtlLexer::STRING ? Word::Kind::string : Word::Kind::symbol;
}

}  // namespace

std::vector<Word> words_of(const source::File& file) {
    return words_of(tokens_of(file), file);
}

std::vector<Word> words_of(const Tokens& tokens, const source::File& file) {
    std::vector<Word> words;
    for (const auto& token : tokens)
        if (token->getType() != Token::EOF)
            words.push_back({kind_of(*token, file), span_of(*token)});
    return words;
}

bool is_name(std::string_view text) {
    const source::File file("", std::string(text));
    const std::vector<Word> words = words_of(file);
    const bool whole =
        words.size() == 1 && words[0].span.begin == 0 && words[0].span.end == text.size();
    return whole && (words[0].kind == Word::Kind::name || words[0].kind == Word::Kind::contextual);
}

}  // namespace etlc::parse
