// The words of the language and their meanings, one line each.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace etlc::lsp {

struct WordInfo {
    enum class Kind : std::uint8_t {
        declaration,
        keyword,
        type,
        unit,
        operation,
        aggregation,
        function,
        distance,
    };
    std::string_view word;
    Kind kind;
    std::string_view form;  ///< syntax: "F[a, b] f"
    std::string_view meaning;
};

const std::vector<WordInfo>& all_words();
/// Finds a word of the language; null for any other word.
const WordInfo* find_word(std::string_view word);

}  // namespace etlc::lsp
