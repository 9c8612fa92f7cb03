// The words of a file that has been lexed.
#pragma once

#include <vector>

#include "parse/stream/tokens.hpp"
#include "parse/words.hpp"

namespace etlc::parse {

std::vector<Word> words_of(const Tokens& tokens, const source::File& file);

}  // namespace etlc::parse
