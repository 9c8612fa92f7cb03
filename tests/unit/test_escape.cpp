// Tests text from outside in each kind of output.
#include <gtest/gtest.h>

#include "source/text.hpp"

namespace {

using namespace etlc::source;

TEST(Escape, PlainWordsStay) {
    for (const char* text :
         {"", "a b", "Z\xC3\xBCrich \xE2\x82\xAC \xF0\x9F\x98\x80", "a\\b/c'd\"e"}) {
        EXPECT_EQ(visible(text), text);
        EXPECT_EQ(code_line(text), text);
    }
}

TEST(Escape, WhatAReaderWouldNotSeeIsSpelt) {
    EXPECT_EQ(visible("a\nb\r\t\x1b[0m\x7f"), "a\\x0ab\\x0d\\x09\\x1b[0m\\x7f");
    EXPECT_EQ(visible("\xE2\x80\xAE\xE2\x81\xA6\xD8\x9C\xC2\x9B\xE2\x80\x8B"),
              "\\u{202E}\\u{2066}\\u{61C}\\u{9B}\\u{200B}");
    EXPECT_EQ(visible("\xff\xC0\xAF\xED\xA0\x80"), "\\xff\\xc0\\xaf\\xed\\xa0\\x80");
    EXPECT_EQ(visible_lines("a\n\tb\n"), "a\n\\x09b\n");
}

TEST(Escape, ALineOfCodeEndsWhereItEnds) {
    EXPECT_EQ(code_line("// a\\"), "// a\\x5c");
    EXPECT_EQ(code_line("// a\\  "), "// a\\x5c");
    EXPECT_EQ(code_line("// a?\?/"), "// a?\?\\x2f");
    EXPECT_EQ(code_line("// a\\b ?\?/ c"), "// a\\b ?\?/ c");
}

TEST(Escape, JsonAndDot) {
    EXPECT_EQ(json_string("a\"\\\n\xff\xC3\xA9"), "\"a\\\"\\\\\\u000a\\ufffd\xC3\xA9\"");
    EXPECT_EQ(dot_string("a\"\\\n"), "\"a\\\"\\\\\\\\x0a\"");
}

TEST(Escape, PathsInDepfiles) {
    EXPECT_EQ(depfile_path("a b#c:d$e%", InRule::prerequisite), "a\\ b\\#c\\:d$$e%");
    EXPECT_EQ(depfile_path("a%", InRule::target), std::nullopt);
    for (const char* path : {"", "a\n", "a\tb", "a\\b", "a;b", "a*", "~a", "a ", "a:", "l(m)"})
        EXPECT_EQ(depfile_path(path, InRule::prerequisite), std::nullopt) << path;
}

}  // namespace
