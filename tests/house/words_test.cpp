// Checks what people read: lines fit on a screen, and links lead somewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tree.hpp"

namespace etlc::house {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 100;

/// Endings and names of the text files that people edit.
const std::set<std::string> kEdited = {
    ".md",          ".sh",         ".cmake",         ".in",
    ".py",          ".yml",        ".yaml",          ".hs",
    ".ld",          ".S",          ".etl",           ".g4",
    ".def",         ".cpp",        ".hpp",           ".inc",
    ".h",           ".c",          "CMakeLists.txt", "CMakePresets.json",
    "packages.txt", ".clang-tidy", ".clang-format"};

/// Folders written by programs, or with deliberate mistakes.
const std::vector<std::string> kNotEdited = {
    "tests/fuzz/corpus/",  // input for parsers
    "tests/spec/error/",   // specs with mistakes, which the expected messages quote line by line
};

bool edited(const fs::path& file) {
    for (const std::string& folder : kNotEdited) {
        if (file.string().starts_with(folder) && file.extension() != ".sh") return false;
    }
    return kEdited.contains(file.extension()) || kEdited.contains(file.filename());
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// Counts characters, not bytes.
std::size_t columns(const std::string& line) {
    return static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    }));
}

/// Returns whether a line is one word, perhaps after a comment or list mark: a link or a path.
bool cannot_be_broken(const std::string& line) {
    static const std::regex kOneWord(R"(^\s*(//+|#+|[-*]|\d+\.)?\s*\S+$)");
    return std::regex_match(line, kOneWord);
}

/// Walks through a page of Markdown: whether a line is in a fence, and in one that shows commands
/// ("$ ...") with their output.
class Fences {
public:
    explicit Fences(const std::vector<std::string>& lines) : lines_(lines) {}

    /// Call it for each line, in order.
    void enter(std::size_t line) {
        const std::string& text = lines_[line];
        edge_ = text.find("```") == text.find_first_not_of(' ') && text.find("```") != text.npos;
        if (!edge_) return;
        inside_ = !inside_;
        session_ = false;
        for (std::size_t next = line + 1; inside_ && next < lines_.size(); ++next) {
            if (lines_[next].find("```") != std::string::npos) break;
            session_ = session_ || lines_[next].starts_with("$ ");
        }
    }
    bool code() const { return inside_ || edge_; }
    /// Returns whether a line is output of a command.
    bool output(std::size_t line) const { return session_ && !lines_[line].starts_with("$ "); }

private:
    const std::vector<std::string>& lines_;
    bool edge_ = false, inside_ = false, session_ = false;
};

TEST(Words, LinesHaveAHundredColumns) {
    for (const auto& file : files()) {
        if (!edited(file)) continue;
        const bool page = file.extension() == ".md";
        const std::vector<std::string> lines = lines_of(content(file));
        Fences fences(lines);
        for (std::size_t n = 0; n < lines.size(); ++n) {
            if (page) fences.enter(n);
            if (columns(lines[n]) <= kColumns || cannot_be_broken(lines[n])) continue;
            if (page && (lines[n].starts_with("|") || fences.output(n))) continue;
            ADD_FAILURE() << file.string() << ":" << n + 1 << ": " << columns(lines[n])
                          << " columns: " << lines[n];
        }
    }
}

/// Phrases that sound translated. Write instead: "compared with", "lead back to", "really",
/// "without". A comment before a declaration is a sentence or a noun: it begins neither with "Of"
/// nor with "What".
TEST(Words, EnglishIsPlain) {
    static const std::regex kGone(
        R"(\b(anew|held against|finds? back to|in earnest|for want of|a share of nothing)\b)"
        R"(|^ */// (Of|What) )");
    for (const auto& file : files()) {
        if (!edited(file) || file == "tests/house/words_test.cpp") continue;
        const std::vector<std::string> lines = lines_of(content(file));
        for (std::size_t n = 0; n < lines.size(); ++n) {
            EXPECT_FALSE(std::regex_search(lines[n], kGone))
                << file.string() << ":" << n + 1 << ": " << lines[n];
        }
    }
}

/// Returns GitHub's anchor for a heading: "## In CMake, `x`" becomes "in-cmake-x".
std::string anchor(const std::string& heading) {
    std::string made;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || c == '-' || c == '_' || byte >= 0x80) {
            made += static_cast<char>(std::tolower(byte));
        } else if (c == ' ') {
            made += '-';
        }
    }
    return made;
}

std::set<std::string> anchors(const fs::path& page) {
    static const std::regex kHeading(R"(^#+ +(.*?) *$)");
    std::set<std::string> found;
    const std::vector<std::string> lines = lines_of(content(page));
    Fences fences(lines);
    for (std::size_t n = 0; n < lines.size(); ++n) {
        fences.enter(n);
        std::smatch match;
        if (!fences.code() && std::regex_match(lines[n], match, kHeading))
            found.insert(anchor(match[1]));
    }
    return found;
}

/// Returns the targets of the links of a page, except those to other sites.
std::vector<std::string> links(const fs::path& page) {
    static const std::regex kLink(R"(\]\(([^()\s]+)\)|^\[[^\]]+\]: (\S+)$)");
    std::vector<std::string> found;
    const std::vector<std::string> lines = lines_of(content(page));
    Fences fences(lines);
    for (std::size_t n = 0; n < lines.size(); ++n) {
        fences.enter(n);
        if (fences.code()) continue;
        for (std::sregex_iterator link(lines[n].begin(), lines[n].end(), kLink);
             link != std::sregex_iterator(); ++link) {
            const std::string to = (*link)[1].matched ? (*link)[1] : (*link)[2];
            if (to.find("://") == std::string::npos) found.push_back(to);
        }
    }
    return found;
}

TEST(Words, LinksLeadToFilesAndHeadings) {
    std::size_t looked_at = 0;
    for (const auto& page : files()) {
        if (page.extension() != ".md") continue;
        for (const std::string& link : links(page)) {
            const std::string path = link.substr(0, link.find('#'));
            const fs::path to =
                path.empty() ? page : (page.parent_path() / path).lexically_normal();
            EXPECT_TRUE(fs::exists(fs::path(ETLC_SOURCE_DIR) / to))
                << page.string() << " links to " << link;
            if (link.find('#') != std::string::npos && to.extension() == ".md") {
                EXPECT_TRUE(anchors(to).contains(link.substr(link.find('#') + 1)))
                    << page.string() << " links to " << link;
            }
            ++looked_at;
        }
    }
    EXPECT_GT(looked_at, 50U);
}

TEST(Words, EveryPageIsInTheIndex) {
    std::set<std::string> listed;
    for (const std::string& link : links("docs/README.md")) {
        listed.insert((fs::path("docs") / link.substr(0, link.find('#'))).lexically_normal());
    }
    for (const auto& page : files("docs")) {
        if (page.extension() != ".md" || page == "docs/README.md") continue;
        EXPECT_TRUE(listed.contains(page)) << page << " is not in docs/README.md";
    }
}

}  // namespace
}  // namespace etlc::house
