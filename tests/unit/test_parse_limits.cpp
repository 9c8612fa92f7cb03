// Tests large and deep input: refused with one error beyond a limit, read in linear time otherwise.
#include <gtest/gtest.h>

#include "parsing.hpp"

namespace {

using namespace etlc;

std::string repeated(const std::string& part, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += part;
    return text;
}

std::string formula(const std::string& text) {
    return "spec a; let f = " + text + "; let g = b;";
}

/// Expects one error, about nesting, and the declaration after it.
void expect_too_deep(const std::string& text) {
    const Parsed parsed(formula(text));
    ASSERT_EQ(parsed.sink.errors(), 1U) << parsed.errors();
    EXPECT_EQ(parsed.sink.sorted()[0].code, diag::Code::nesting_too_deep);
    EXPECT_EQ(parsed.tree(), "spec a\n(let g b)\n");
    EXPECT_EQ(parsed.spec.unreadable.at(0).text, "f");
}

void expect_fine(const std::string& text) {
    EXPECT_EQ(Parsed(formula(text)).errors(), "");
}

/// Everything that the parser reads recursively, nested `n` deep.
std::vector<std::string> nested(int n) {
    return {
        repeated("(", n) + "a" + repeated(")", n),
        repeated("(", n) + "x + y" + repeated(")", n) + " > 1",
        repeated("abs(", n) + "x" + repeated(")", n) + " > 1",
        repeated("!", n) + "a",
        repeated("F[0, 1] ", n) + "a",
        repeated("G ! ", n / 2) + "a",
        repeated("- ", n) + "x > 1",
        "y - " + repeated("- ", n) + "x > 1",
        repeated("a -> ", n) + "a",
        repeated("a U[0, 2] ", n) + "a",
        repeated("a U b && ", 3) + repeated("a W ", n) + "a",
        repeated("(!", n / 2) + "a" + repeated(")", n / 2),
        repeated("(a -> ", n / 2) + "a" + repeated(")", n / 2),
    };
}

TEST(Limits, NestingUpToTheLimit) {
    for (const std::string& text : nested(parse::kMaxNesting - 2)) expect_fine(text);
}

TEST(Limits, NestingBeyondTheLimit) {
    for (const std::string& text : nested(parse::kMaxNesting + 2)) expect_too_deep(text);
}

TEST(Limits, NestingFarBeyondTheLimit) {
    for (const std::string& text : nested(100000)) expect_too_deep(text);
}

TEST(Limits, UnbalancedBrackets) {
    expect_too_deep(repeated("(", 100000));
    EXPECT_EQ(Parsed(formula(repeated(")", 100000))).sink.errors(), 1U);
    expect_too_deep(repeated("[", 100000));
}

TEST(Limits, SiblingsDoNotNest) {
    expect_fine(repeated("(!a) && ", 2000) + "!a");
    expect_fine(repeated("a -> b <-> ", 500) + "c");
    expect_fine(repeated("a U b && ", 2000) + "c");
    expect_fine(repeated("-x > 1 || ", 2000) + "c");
}

TEST(Limits, LongConjunctionsAreOneNode) {
    const Parsed parsed(formula(repeated("a && ", 99999) + "a"));
    ASSERT_EQ(parsed.errors(), "");
    EXPECT_EQ(std::get<ast::Let>(parsed.spec.declarations[0]).formula->operands.size(), 100000U);
}

TEST(Limits, ChainsThatNestToTheLeft) {
    for (const std::string op : {"+", "-", "*", "/"}) {
        expect_fine(repeated("x " + op + " ", parse::kMaxHeight - 2) + "x > 1");
        expect_too_deep(repeated("x " + op + " ", parse::kMaxHeight) + "x > 1");
    }
    expect_too_deep(repeated("x + ", 100000) + "x > 1");
    expect_fine(repeated("a <-> ", parse::kMaxHeight - 2) + "a");
    expect_too_deep(repeated("a <-> ", 100000) + "a");
    // Heights add up across brackets.
    const std::string sum = repeated("x + ", 600) + "x";
    expect_fine("y + (" + sum + ") > 1");
    expect_too_deep("(" + sum + ")" + repeated(" + x", 600) + " > 1");
}

TEST(Limits, SpecsThatAreTooLarge) {
    const Parsed parsed("spec a;\n" + std::string(10U << 20U, ' '));
    EXPECT_EQ(parsed.brief(),
              "E0111 0:0 the spec has 10485768 bytes; etlc reads at most 1048576\n");
    std::string largest = "spec a;";
    largest.resize(parse::kMaxSpecBytes, ' ');
    EXPECT_EQ(Parsed(largest).errors(), "");
}

TEST(Limits, ManyErrorsInOneLine) {
    const Parsed parsed("spec a;" + repeated("let f=;", 20000));
    EXPECT_EQ(parsed.sink.errors(), 20000U);
    EXPECT_LT(parsed.errors().size(), 100000U);
}

TEST(Limits, TextThatInvitesRereading) {
    EXPECT_EQ(Parsed("spec a;\n" + repeated("/* ", 300000)).sink.errors(), 1U);
    EXPECT_EQ(Parsed("spec a;\n" + repeated("\"\n", 300000)).sink.errors(), 1U);
    EXPECT_EQ(Parsed("spec a;\n" + repeated(";", 200000)).sink.errors(), 1U);
    EXPECT_EQ(Parsed("spec a;\n" + repeated("1.", 300000)).sink.errors(), 1U);
}

}  // namespace
