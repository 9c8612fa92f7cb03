// The words of a text, for editors.
// Takes: a file. Gives: what the lexer makes of it, with the place of each word; blanks and
// comments lie between them. Keeps true: any bytes are words; they stand in order and do not
// overlap.
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
        contextual,  ///< a word of the language where it can be one, else a name
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

/// Whether the grammar takes `text` as a name, as it does contextual words.
bool is_name(std::string_view text);

}  // namespace etlc::parse
