// Rules for every file of the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>
#include <string>

#include "tree.hpp"

namespace etlc::house {
namespace {

/// Returns whether `text` contains the absolute path `path`, not a relative one with the same end.
bool names_path(const std::string& text, const std::string& path) {
    for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at + 1)) {
        const char before = at == 0 ? ' ' : text[at - 1];
        if (std::isalnum(static_cast<unsigned char>(before)) == 0 &&
            std::string("._-}$)").find(before) == std::string::npos)
            return true;
    }
    return false;
}

TEST(Tree, SourcesAreShort) {
    for (const char* folder :
         {"base", "compiler", "workbench", "runtime", "tests", "examples", "bench"}) {
        for (const auto& file : cpp_files(folder)) {
            const std::string text = content(file);
            EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 800)
                << file << " is perhaps two things";
        }
    }
}

/// Checks the rule of distances.def. Two words represent all: others have further meanings.
TEST(Tree, DistancesAreNamedInOneFile) {
    static const std::set<std::string> kTheirs = {"runtime/include/etlmon/distance/distances.def",
                                                  "grammar/EtlLexer.g4"};
    static const std::set<std::string> kDefinitions = {
        "compiler/reference/distance.cpp",   "workbench/episodes/truth.cpp",
        "workbench/calibrate/bounds.cpp",    "compiler/plan/targets/narrow_targets.cpp",
        "workbench/lsp/answers/words.def",   "compiler/parse/foreign/words.def",
        "workbench/fit/suggest/suggest.cpp", "runtime/include/etlmon/hosted/error_bounds.hpp"};
    static const std::regex kWord(R"(\b(l2sq|linf)\b)");
    static const std::regex kComment(R"(//[^\n]*)");
    for (const char* folder : {"base", "compiler", "workbench", "runtime", "grammar"}) {
        for (const auto& file : files(folder)) {
            const std::string text = std::regex_replace(content(file), kComment, "");
            const bool named = std::regex_search(text, kWord);
            if (kTheirs.contains(file)) {
                EXPECT_TRUE(named) << file;
            } else if (!kDefinitions.contains(file)) {
                EXPECT_FALSE(named) << file << " names a distance: make that of distances.def";
            }
        }
    }
}

TEST(Tree, NothingNamesTheMachineItWasWrittenOn) {
    static const std::regex kHome(R"(/(home|Users)/[a-z]\w*/|/root/\.)");
    for (const auto& file : files()) {
        const std::string text = content(file);
        EXPECT_FALSE(names_path(text, ETLC_SOURCE_DIR "/"))
            << file << " names the folder of this clone";
        EXPECT_FALSE(names_path(text, ETLC_BINARY_DIR)) << file << " names the build folder";
        std::smatch match;
        const bool found = text.size() < 200'000 && std::regex_search(text, match, kHome);
        EXPECT_FALSE(found) << file << " names " << match.str();
    }
}

TEST(Tree, HeadersAreIncludedOnceAndSayWhatTheyAre) {
    for (const char* folder : {"base", "compiler", "workbench", "runtime"}) {
        for (const auto& file : cpp_files(folder)) {
            if (file.extension() != ".hpp") continue;
            const std::string text = content(file);
            EXPECT_TRUE(text.starts_with("//") || text.starts_with("/*"))
                << file << " does not open with what it takes, gives and keeps true";
            EXPECT_NE(text.find("#pragma once"), std::string::npos) << file;
        }
    }
}

TEST(Tree, NamesSayWhatAThingIs) {
    static const std::regex kVague("^(utils?|helpers?|common|managers?|misc)\\b");
    for (const auto& file : files()) {
        for (const auto& part : file) {
            EXPECT_FALSE(std::regex_search(part.string(), kVague)) << file;
        }
    }
}

}  // namespace
}  // namespace etlc::house
