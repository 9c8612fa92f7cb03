// The words of a text, for editors: the lexer's tokens with their places, in order. Blanks and
// comments lie between them; any bytes are words.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "source/source.hpp"

namespace etlc::parse {

struct Word {
    enum class Kind : std::uint8_t {
        reserved,    ///< cannot be a name
        contextual,  ///< a word of the language in some places, otherwise a name
        name,
        number,
        string,
        symbol,
        mistake,
    };
    Kind kind;
    source::Span span;
};

std::vector<Word> words_of(const source::File& file);

/// Whether the grammar accepts `text` as a name; contextual words count.
bool is_name(std::string_view text);

}  // namespace etlc::parse
