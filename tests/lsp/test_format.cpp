// Formats every good spec, with comments and line breaks inserted between its words.
#include <gtest/gtest.h>

#include <random>

#include "good_specs.hpp"
#include "lsp/format/format.hpp"
#include "sound_format.hpp"

namespace etlc::lsp {
namespace {

TEST(Format, GoodSpecsStayWhatTheyAre) {
    const auto specs = good_specs();
    EXPECT_GT(specs.size(), 150U);
    for (const std::string& text : specs) EXPECT_EQ(mistake_in_format(text), "") << text;
}

TEST(Format, CommentsStayBetweenTheirWords) {
    std::mt19937 random(7);
    const std::vector<std::string> thrown{
        "\n",   " ",  "/* a */",  "// b\n", "\n\n\n", "/* c\n*/", "\n// d ;\n",
        "\r\n", "\t", "// e\r\n", "/**/",   "//\n",   "/* ; */\n"};
    for (const std::string& text : good_specs()) {
        const source::File file("", text);
        std::string changed;
        std::uint32_t from = 0;
        int comments = 0;
        for (const parse::Word& word : parse::words_of(file)) {
            changed += file.text({from, word.span.begin});
            if (random() % 8 == 0) changed += " " + thrown[random() % thrown.size()] + " ";
            if (random() % 40 == 0)
                changed +=
                    " /* " + std::to_string(++comments) + " */ " + thrown[random() % 6] + " ";
            changed += file.text(word.span);
            from = word.span.end;
        }
        changed += file.text({from, static_cast<std::uint32_t>(text.size())});
        EXPECT_EQ(mistake_in_format(changed), "") << changed;
    }
}

TEST(Format, LineEndsWithinCommentsDoNotCount) {
    const std::string text = "spec /* c\n*/ c; input p : bool;\r\nmonitor m = p; // the end\r\n";
    EXPECT_EQ(mistake_in_format(text), "");
}

std::string format(const std::string& text) {
    return formatted(source::File("", text)).value_or("unreadable");
}

TEST(Format, WhatCannotBeReadIsLeftAlone) {
    EXPECT_EQ(format("spec a; monitor m = ;"), "unreadable");
    EXPECT_EQ(format(""), "unreadable");
    EXPECT_EQ(format("spec a; monitor m = true; /* open"), "unreadable");
}

TEST(Format, CommentsBehindDeclarationsBeginInOneColumn) {
    EXPECT_EQ(format("spec a;\n\ninput p:bool; //p\ninput long_one:bool;\ninput q :bool;//q\n"
                     "\ninput r:bool; // r\nmonitor m=\nG p; // two lines\n"),
              "spec a;\n\ninput p : bool;  //p\ninput long_one : bool;\ninput q : bool;  //q\n"
              "\ninput r : bool;  // r\nmonitor m =\n    G p;  // two lines\n");
}

TEST(Format, CommentsOfBracketsThatGoStayBesideTheirWords) {
    EXPECT_EQ(format("spec a;input p,q:bool;let x = /*1*/(/*2*/p/*3*/)/*4*/&& (/*5*/(q))/*6*/;"),
              "spec a;\ninput p, q : bool;\nlet x = /*1*/ /*2*/ p /*3*/ /*4*/ && /*5*/ q /*6*/;\n");
}

}  // namespace
}  // namespace etlc::lsp
