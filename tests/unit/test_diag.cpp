#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "diag/diag.hpp"

namespace {

using namespace etlc;
using diag::Code;
using diag::Sink;
using source::File;
using source::Span;

std::string text_of(const std::string& spec, Span span) {
    const File file("a.etl", spec);
    Sink sink;
    sink.report(Code::syntax_error, span, "wrong");
    return diag::render_text(file, sink);
}

Span span_of(const std::string& text, const std::string& part) {
    const auto begin = static_cast<std::uint32_t>(text.find(part));
    return {begin, begin + static_cast<std::uint32_t>(part.size())};
}

// ---- the table of codes

TEST(Codes, AreSortedAndUnique) {
    const auto& codes = diag::all_codes();
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        EXPECT_TRUE(names.insert(codes[i].name).second) << codes[i].name << " is there twice";
        const bool warning = codes[i].severity == diag::Severity::warning;
        EXPECT_EQ(codes[i].code[0], warning ? 'W' : 'E') << codes[i].code;
        EXPECT_EQ(codes[i].code.size(), 5U);
        EXPECT_FALSE(codes[i].summary.empty());
        EXPECT_NE(codes[i].summary.back(), '.');
        EXPECT_TRUE(i == 0 || codes[i - 1].code < codes[i].code) << codes[i].code;
    }
}

TEST(Codes, InfoFindsTheRow) {
    EXPECT_EQ(diag::info(Code::syntax_error).code, "E0104");
    EXPECT_EQ(diag::info(Code::syntax_error).name, "syntax_error");
    EXPECT_EQ(diag::info(Code::syntax_error).severity, diag::Severity::error);
}

// ---- text

TEST(Text, NothingFoundIsNothingSaid) {
    EXPECT_EQ(diag::render_text(File("a.etl", "x"), Sink()), "");
}

TEST(Text, HeadlineSourceCaretSummary) {
    const std::string spec = "spec a;\nlet f = b c;\n";
    EXPECT_EQ(text_of(spec, span_of(spec, "b c")),
              "a.etl:2:9: error: wrong [E0104]\n"
              "    2 | let f = b c;\n"
              "      |         ^~~\n"
              "1 error\n");
}

TEST(Text, TabsKeepTheCaretsAligned) {
    const std::string spec = "\tlet\tf = b;";
    EXPECT_EQ(text_of(spec, span_of(spec, "f")),
              "a.etl:1:6: error: wrong [E0104]\n"
              "    1 | \tlet\tf = b;\n"
              "      | \t   \t^\n"
              "1 error\n");
}

TEST(Text, SpansOfManyLinesShowTheFirst) {
    const std::string spec = "let f = (a &&\n  b);\n";
    EXPECT_EQ(text_of(spec, span_of(spec, "(a &&\n  b)")),
              "a.etl:1:9: error: wrong [E0104]\n"
              "    1 | let f = (a &&\n"
              "      |         ^~~~~\n"
              "1 error\n");
}

TEST(Text, PlacesAtTheEndOfALineAndOfTheFile) {
    EXPECT_EQ(text_of("ab\ncd", {2, 2}),
              "a.etl:1:3: error: wrong [E0104]\n    1 | ab\n      |   ^\n1 error\n");
    EXPECT_EQ(text_of("ab\ncd", {5, 5}),
              "a.etl:2:3: error: wrong [E0104]\n    2 | cd\n      |   ^\n1 error\n");
    EXPECT_EQ(text_of("", {0, 0}),
              "a.etl:1:1: error: wrong [E0104]\n    1 | \n      | ^\n1 error\n");
    EXPECT_EQ(text_of("ab\r\n", {2, 4}),
              "a.etl:1:3: error: wrong [E0104]\n    1 | ab\n      |   ^\n1 error\n");
}

TEST(Text, WideAndCombiningCharactersTakeTheirColumns) {
    const std::string spec = "日本 x";
    EXPECT_EQ(text_of(spec, span_of(spec, "x")),
              "a.etl:1:4: error: wrong [E0104]\n    1 | 日本 x\n      |      ^\n1 error\n");
    const std::string combined = "e\xCC\x81 x";  // e, combining acute
    EXPECT_EQ(text_of(combined, span_of(combined, "x")),
              "a.etl:1:4: error: wrong [E0104]\n    1 | e\xCC\x81 x\n      |   ^\n1 error\n");
    EXPECT_EQ(text_of(spec, span_of(spec, "日")),
              "a.etl:1:1: error: wrong [E0104]\n    1 | 日本 x\n      | ^~\n1 error\n");
}

TEST(Text, BytesThatAreNotTextAreReplaced) {
    EXPECT_EQ(text_of("a\xFF\x1B[31m b", {8, 9}),
              "a.etl:1:9: error: wrong [E0104]\n    1 | a\xEF\xBF\xBD\xEF\xBF\xBD[31m b\n      |   "
              "      ^\n1 error\n");
}

TEST(Text, LongLinesAreCutAroundTheSpan) {
    const std::string spec = std::string(5000, 'a') + " here " + std::string(5000, 'b');
    const std::string text = text_of(spec, span_of(spec, "here"));
    const std::size_t caret_line = text.find("      | ");
    const std::size_t caret = text.find("^~~~", caret_line) - caret_line;
    const std::size_t source_line = text.find("    1 | ");
    EXPECT_EQ(text.substr(source_line + caret, 4), "here");
    EXPECT_LT(text.size(), 400U);
    EXPECT_NE(text.find("| ...aaa"), std::string::npos);
    EXPECT_NE(text.find("bbb...\n"), std::string::npos);
}

TEST(Text, NotesWithAndWithoutPlaces) {
    const std::string spec = "input a : f32;\ninput a : f32;\n";
    const File file("a.etl", spec);
    Sink sink;
    sink.report(Code::syntax_error, {21, 22}, "twice")
        .note(Span{6, 7}, "first here")
        .note("choose another name");
    EXPECT_EQ(diag::render_text(file, sink),
              "a.etl:2:7: error: twice [E0104]\n"
              "    2 | input a : f32;\n"
              "      |       ^\n"
              "a.etl:1:7: note: first here\n"
              "    1 | input a : f32;\n"
              "      |       ^\n"
              "      = note: choose another name\n"
              "1 error\n");
}

TEST(Text, OtherFilesAndTheWholeSpec) {
    const File file("a.etl", "spec a;");
    Sink sink;
    sink.report({Code::syntax_error, "bad", Span{0, 4}, "t.json", 3, 7, {}});
    sink.report({Code::syntax_error, "bad", {}, "s.json", 3, 0, {}});
    sink.report({Code::syntax_error, "whole", {}, {}, 0, 0, {}});
    EXPECT_EQ(diag::render_text(file, sink),
              "a.etl: error: whole [E0104]\n"
              "s.json:3: error: bad [E0104]\n"
              "t.json:3:7: error: bad [E0104]\n"
              "a.etl:1:1: note: named here\n"
              "    1 | spec a;\n"
              "      | ^~~~\n"
              "3 errors\n");
}

TEST(Text, InTheOrderOfTheirPlaces) {
    const File file("a.etl", "abc");
    Sink sink;
    sink.report(Code::syntax_error, {2, 3}, "third");
    sink.report(Code::syntax_error, {0, 1}, "first");
    sink.report(Code::reserved_name, {0, 1}, "second");
    const auto sorted = sink.sorted();
    EXPECT_EQ(sorted[0].message, "first");
    EXPECT_EQ(sorted[1].message, "second");
    EXPECT_EQ(sorted[2].message, "third");
    EXPECT_EQ(sink.errors(), 3U);
    EXPECT_EQ(sink.warnings(), 0U);
}

TEST(Text, ColoursOnlyWhenAsked) {
    const File file("a.etl", "abc");
    Sink sink;
    sink.report(Code::syntax_error, {0, 1}, "x");
    EXPECT_EQ(diag::render_text(file, sink).find('\x1b'), std::string::npos);
    EXPECT_NE(diag::render_text(file, sink, diag::Colour::ansi).find("\x1b[1;31merror:"),
              std::string::npos);
}

TEST(Text, ManyFindingsAreCountedNotAllShown) {
    const File file("a.etl", "abc");
    Sink sink;
    for (int i = 0; i < 1000; ++i) sink.report(Code::syntax_error, {0, 1}, "x");
    const std::string text = diag::render_text(file, sink);
    EXPECT_NE(text.find("(800 more not shown)\n1000 errors\n"), std::string::npos);
}

/// Any warning of the table; the tests below need just one.
Code some_warning() {
    const auto& codes = diag::all_codes();
    const auto found = std::find_if(codes.begin(), codes.end(), [](const auto& row) {
        return row.severity == diag::Severity::warning;
    });
    return static_cast<Code>(found - codes.begin());
}

TEST(Text, WarningsAndWerror) {
    const File file("a.etl", "abc");
    const auto text = [&](Sink sink) {
        sink.report(Code::syntax_error, {0, 1}, "x");
        sink.report(some_warning(), {1, 2}, "y");
        sink.report(some_warning(), {2, 3}, "z");
        EXPECT_EQ(sink.errors(), 1U);
        EXPECT_EQ(sink.warnings(), 2U);
        return diag::render_text(file, sink);
    };
    const std::string plain = text(Sink());
    EXPECT_NE(plain.find("a.etl:1:2: warning: y"), std::string::npos);
    EXPECT_NE(plain.find("1 error, 2 warnings\n"), std::string::npos);
    const std::string strict = text(Sink(true));
    EXPECT_NE(strict.find("a.etl:1:2: error: y"), std::string::npos);
    EXPECT_NE(strict.find("3 errors\n"), std::string::npos);
}

// ---- JSON

TEST(Json, HoldsEveryFinding) {
    const File file("a.etl", "ab\ncd");
    Sink sink;
    sink.report(Code::syntax_error, {1, 4}, "over two lines")
        .note(Span{0, 1}, "here")
        .note("just so");
    sink.report({Code::syntax_error, "elsewhere", {}, "t.json", 3, 7, {}});
    const auto json = nlohmann::json::parse(diag::render_json(file, sink));
    ASSERT_EQ(json["diagnostics"].size(), 2U);
    const auto& first = json["diagnostics"][0];
    EXPECT_EQ(first["code"], "E0104");
    EXPECT_EQ(first["name"], "syntax_error");
    EXPECT_EQ(first["severity"], "error");
    EXPECT_EQ(first["message"], "over two lines");
    EXPECT_EQ(first["file"], "a.etl");
    EXPECT_EQ(first["line"], 1);
    EXPECT_EQ(first["column"], 2);
    EXPECT_EQ(first["end_line"], 2);
    EXPECT_EQ(first["end_column"], 2);
    ASSERT_EQ(first["notes"].size(), 2U);
    EXPECT_EQ(first["notes"][0]["message"], "here");
    EXPECT_EQ(first["notes"][0]["column"], 1);
    EXPECT_TRUE(first["notes"][1]["line"].is_null());
    const auto& second = json["diagnostics"][1];
    EXPECT_EQ(second["file"], "t.json");
    EXPECT_EQ(second["line"], 3);
    EXPECT_EQ(second["column"], 7);
    EXPECT_TRUE(second["end_line"].is_null());
}

TEST(Json, IsAnEmptyListWhereNothingWasFound) {
    EXPECT_EQ(
        nlohmann::json::parse(diag::render_json(File("a.etl", ""), Sink()))["diagnostics"].size(),
        0U);
}

TEST(Json, SurvivesBytesThatAreNotText) {
    const File file("\xFF.etl", "a");
    Sink sink;
    sink.report(Code::syntax_error, {0, 1}, "found '\xC3'\n\"\\");
    const auto json = nlohmann::json::parse(diag::render_json(file, sink));
    EXPECT_EQ(json["diagnostics"][0]["message"], "found '\xEF\xBF\xBD'\n\"\\");
}

TEST(Json, WarningsAsErrors) {
    const File file("a.etl", "abc");
    const auto severity = [&](Sink sink) {
        EXPECT_FALSE(sink.refused());
        sink.report(some_warning(), {1, 2}, "y");
        EXPECT_FALSE(sink.has_errors());
        return std::pair(sink.refused(), nlohmann::json::parse(diag::render_json(
                                             file, sink))["diagnostics"][0]["severity"]);
    };
    EXPECT_EQ(severity(Sink()), std::pair(false, nlohmann::json("warning")));
    EXPECT_EQ(severity(Sink(true)), std::pair(true, nlohmann::json("error")));
}

// ---- nearest names

std::string nearest(const std::string& name, const std::vector<std::string>& candidates) {
    return diag::nearest_name(name, candidates).value_or("-");
}

TEST(NearestName, OneEditInThreeLetters) {
    EXPECT_EQ(nearest("predicat", {"predicate", "period"}), "predicate");
    EXPECT_EQ(nearest("goal_q", {"goal_a", "corner"}), "goal_a");
    EXPECT_EQ(nearest("cosien", {"cosine"}), "cosine");      // two neighbours swapped
    EXPECT_EQ(nearest("grpper", {"gripper"}), "gripper");    // one left out
    EXPECT_EQ(nearest("grripper", {"gripper"}), "gripper");  // one too many
    EXPECT_EQ(nearest("p1", {"p2"}), "p2");
    EXPECT_EQ(nearest("a", {"b"}), "-");
    EXPECT_EQ(nearest("banana", {"gripper"}), "-");
    EXPECT_EQ(nearest("ab", {"xy"}), "-");
}

TEST(NearestName, AnotherCaseIsNearerThanAnotherLetter) {
    EXPECT_EQ(nearest("Goal", {"foal", "goal"}), "goal");
    EXPECT_EQ(nearest("x", {"y", "X"}), "X");
    EXPECT_EQ(nearest("hz", {"Hz"}), "Hz");
}

TEST(NearestName, TheFirstOfEquallyNearOnes) {
    EXPECT_EQ(nearest("pc", {"pa", "pb"}), "pa");
}

TEST(NearestName, NothingToCompare) {
    EXPECT_EQ(nearest("", {"a"}), "-");
    EXPECT_EQ(nearest("a", {}), "-");
    EXPECT_EQ(nearest("a", {""}), "-");
    EXPECT_EQ(nearest(std::string(100000, 'a'), {std::string(100000, 'a')}), "-");
}

}  // namespace
