#include "lsp/answers/words.hpp"

#include <algorithm>

namespace etlc::lsp {

const std::vector<WordInfo>& all_words() {
    static const std::vector<WordInfo> all{
#define WORD(word, kind, form, meaning) WordInfo{word, WordInfo::Kind::kind, form, meaning},
#include "lsp/answers/words.def"
#undef WORD
    };
    return all;
}

const WordInfo* find_word(std::string_view word) {
    const auto& all = all_words();
    const auto found =
        std::find_if(all.begin(), all.end(), [word](const WordInfo& w) { return w.word == word; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace etlc::lsp
