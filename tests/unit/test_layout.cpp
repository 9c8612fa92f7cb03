// Tests the line breaks of generated code.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "emit/text/layout.hpp"

namespace etlc::emit {

namespace {

std::string wrapped(const std::string& statement) {
    Printer out;
    out.indent();
    print_wrapped(out, statement);
    return out.take();
}

std::string letters(std::size_t n, char letter = 'a') {
    return std::string(n, letter);
}

TEST(Layout, WhatFitsStaysOnALine) {
    const std::string whole = "x = f(" + letters(90) + ");";
    EXPECT_EQ(whole.size() + 2, kLineWidth);
    EXPECT_EQ(wrapped(whole), "  " + whole + "\n");
}

TEST(Layout, ACallBreaksBehindItsBracketAndAtItsOwnCommas) {
    EXPECT_EQ(wrapped("m = a::enclose<a::L2>(a::measure<a::L2, 3, " + letters(20) + ">(" +
                      letters(20, 'z') + ", " + letters(20, 'w') + "), 0.25f, 3);"),
              "  m = a::enclose<a::L2>(\n"
              "      a::measure<a::L2, 3, " +
                  letters(20) + ">(" + letters(20, 'z') + ", " + letters(20, 'w') +
                  "), 0.25f,\n"
                  "      3);\n");
}

TEST(Layout, AnAssignedCallThatFitsStaysWhole) {
    const std::string call = "measure<Cosine, 8, 32, " + letters(50) + ">(z);";
    EXPECT_EQ(wrapped(letters(20, 'b') + " = " + call),
              "  " + letters(20, 'b') + " =\n      " + call + "\n");
}

TEST(Layout, AChoiceStandsOnThreeLines) {
    EXPECT_EQ(
        wrapped("v = exists(3) ? " + letters(50) + "(a, b) : " + letters(30) + "();"),
        "  v = exists(3)\n      ? " + letters(50) + "(a, b)\n      : " + letters(30) + "();\n");
}

TEST(Layout, AListEndsOnALineOfItsOwn) {
    EXPECT_EQ(
        wrapped("const Key k[] = {" + letters(50) + ", f(a, b), " + letters(40) + "};"),
        "  const Key k[] = {\n    " + letters(50) + ", f(a, b),\n    " + letters(40) + "\n  };\n");
}

TEST(Layout, WhatDependsOnAConditionStandsInBraces) {
    EXPECT_EQ(wrapped("if (f(a) && b) c = d;"), "  if (f(a) && b) {\n    c = d;\n  }\n");
    EXPECT_EQ(wrapped("if (" + letters(50) + " && " + letters(50, 'b') + ") c = d;"),
              "  if (" + letters(50) + " &&\n      " + letters(50, 'b') + ") {\n    c = d;\n  }\n");
}

TEST(Layout, AFunctionThatDoesNotFitIsABlock) {
    EXPECT_EQ(wrapped("const Lazy x([&]() noexcept { return f(" + letters(60) + "); });"),
              "  const Lazy x([&]() noexcept {\n    return f(" + letters(60) + ");\n  });\n");
    EXPECT_EQ(wrapped("static Value u() noexcept { return V{" + letters(65) + "}; }"),
              "  static Value u() noexcept {\n    return V{" + letters(65) + "};\n  }\n");
}

TEST(Layout, SignsAreNotBrackets) {
    const std::string below = "i < " + letters(40) + " && " + letters(40, 'b') + " < " +
                              letters(20, 'c') + "(" + letters(10) + ", x)";
    EXPECT_EQ(wrapped("ok = " + below + ";"), "  ok = i < " + letters(40) + " &&\n      " +
                                                  letters(40, 'b') + " < " + letters(20, 'c') +
                                                  "(" + letters(10) + ", x);\n");
}

TEST(Layout, NothingIsLostWhereNothingCanBeBroken) {
    const std::string word = letters(200) + ";";
    EXPECT_EQ(wrapped(word), "  " + word + "\n");
}

TEST(Layout, CommentsBreakBetweenWordsAndFirstBetweenTheirParts) {
    Printer out;
    print_comment(out, "//",
                  "t.etl:3: " + letters(40) + "  (" + letters(30) + " " + letters(30) + ")", 4);
    EXPECT_EQ(out.take(), "// t.etl:3: " + letters(40) + "\n//     (" + letters(30) + " " +
                              letters(30) + ")\n");
}

TEST(Layout, IntervalsAndUnitsStayWhole) {
    const std::string words =
        " F[0, 8 s] held[2 steps] x@3 s > y in [0.5, 1] for 20 min, 50 % of mean(x, 10 ms)";
    const std::vector<std::string> wholes = {"F[0, 8 s]", "held[2 steps]", "x@3 s", "[0.5, 1]",
                                             "20 min",    "50 %",          "10 ms"};
    for (std::size_t n = 1; n < kLineWidth; ++n) {
        Printer comment;
        print_comment(comment, "//", letters(n) + words);
        Printer table;
        print_table(table, "//   ", {{letters(1 + n % 40) + words, letters(n % 7)}}, 2);
        for (const std::string& text : {comment.take(), table.take()})
            for (const std::string& whole : wholes)
                EXPECT_NE(text.find(whole), std::string::npos) << whole << " in\n" << text;
        const std::string room = letters(2 * n) + " F[0, 8 s] ";
        const std::vector<std::string> cuts = {emit::quoted(room + letters(160)),
                                               shortened(room + letters(60))};
        for (const std::string& cut : cuts)
            EXPECT_EQ(cut.find('[') != std::string::npos, cut.find("8 s]") != std::string::npos)
                << cut;
    }
}

TEST(Layout, ALongCommentStandsAboveItsDeclaration) {
    Printer out;
    print_aligned(out, {{"float a;", "first"}, {"float long_name;", letters(90)}, {"int b;", ""}},
                  "///<");
    EXPECT_EQ(out.take(),
              "float a;  ///< first\n/// " + letters(90) + "\nfloat long_name;\nint b;\n");
}

}  // namespace

}  // namespace etlc::emit
