// Every word of the grammar has an explanation for hover and completion.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>

#include "lsp/answers/answers.hpp"

namespace etlc::lsp {
namespace {

std::set<std::string> words_of_lexer() {
    std::ifstream file(ETLC_SOURCE_DIR "/grammar/EtlLexer.g4");
    std::set<std::string> words;
    static const std::regex kQuoted("'([^']*)'");
    for (std::string line; std::getline(file, line) && !line.starts_with("IDENTIFIER");)
        if (!line.starts_with("//"))
            for (std::sregex_iterator at(line.begin(), line.end(), kQuoted), end; at != end; ++at)
                words.insert((*at)[1]);
    return words;
}

TEST(Words, AreThoseOfTheGrammar) {
    std::set<std::string> explained;
    std::set<std::string> arguments;  // which are names to the grammar
    for (const WordInfo& info : all_words()) {
        const bool is_argument = info.kind == WordInfo::Kind::argument;
        EXPECT_TRUE((is_argument ? arguments : explained).emplace(info.word).second)
            << info.word << " twice";
        EXPECT_FALSE(info.form.empty()) << info.word;
        EXPECT_FALSE(info.meaning.empty()) << info.word;
    }
    EXPECT_GT(explained.size(), 80U);
    EXPECT_EQ(explained, words_of_lexer());
    for (const std::string& word : arguments) EXPECT_FALSE(explained.contains(word)) << word;
}

}  // namespace
}  // namespace etlc::lsp
