// Tests errors: one message per broken declaration, in the user's terms, and the rest of the file
// is still read.
#include <gtest/gtest.h>

#include "parsing.hpp"

namespace {

using namespace etlc;

std::string brief(const std::string& text) {
    return Parsed(text).brief();
}

/// Returns the messages about one declaration on its own line after `spec a;`.
std::string of_line(const std::string& line) {
    return brief("spec a;\n" + line + "\n");
}

// ---- recovery

TEST(Recovery, EveryBrokenDeclarationHasOneError) {
    const Parsed parsed(
        "spec a;\n"
        "let b = c && ;\n"
        "input x : f32;\n"
        "predicate p = x > > 1;\n"
        "monitor m = F x > 0;\n");
    EXPECT_EQ(
        parsed.brief(),
        "E0104 2:14 expected a formula after '&&', found ';'\n"
        "E0104 4:19 expected a threshold (a number, an expression or calibrated(...)) after '>', "
        "found '>'\n");
    EXPECT_EQ(parsed.tree(), "spec a\n(input x :f32)\n(monitor m (F (> x 0)))\n");
    ASSERT_EQ(parsed.spec.unreadable.size(), 2U);
    EXPECT_EQ(parsed.spec.unreadable[0].text, "b");
    EXPECT_EQ(parsed.spec.unreadable[1].text, "p");
    EXPECT_EQ(parsed.file.text(parsed.spec.unreadable[1].span), "p");
}

TEST(Recovery, AMissingSemicolonEndsAtTheNextDeclaration) {
    const Parsed parsed(
        "spec a\nlet f = b\nlet g = c;\nsliding monitor m = G[0, 2] f\nrate 20 Hz;");
    EXPECT_EQ(parsed.brief(),
              "E0104 1:7 expected ';' after 'a', found 'let'\n"
              "E0104 2:10 expected an operator or ';' after 'b', found 'let'\n"
              "E0104 4:30 expected an operator or ';' after 'f', found 'rate'\n");
    EXPECT_EQ(parsed.spec.declarations.size(), 2U);
}

TEST(Recovery, TheEndOfTheFile) {
    EXPECT_EQ(of_line("let f = a"),
              "E0104 2:10 expected an operator or ';' after 'a', found the end of the file\n");
    EXPECT_EQ(of_line("let"), "E0104 2:4 expected a name after 'let', found the end of the file\n");
    EXPECT_EQ(of_line("let f = (a;"),
              "E0104 2:11 expected an operator or ')' after 'a', found ';'\n");
}

TEST(Recovery, NamesOfWhatCouldNotBeRead) {
    const Parsed parsed(
        "spec a;\n"
        "input x, y, : f32;\ninput u v : f32;\npredicat p = x > 1;\nsliding monitor m = ;\ntarget "
        "t = ;\n"
        "truth q = ;\nrate 20;\nlet = 3;\n");
    std::string names;
    for (const ast::Name& name : parsed.spec.unreadable) names += name.text + " ";
    EXPECT_EQ(names, "x y u p m t rate ");
}

TEST(Recovery, ReservedWordsUsedAsNamesAreToldOnce) {
    const Parsed parsed(
        "spec a;\ninput F, x : f32;\nlet f = F > 1;\nlet g = x && ;\nlet h = x + F > 2;\n");
    EXPECT_EQ(parsed.brief(),
              "E0105 2:7 'F' is reserved and cannot be a name\n"
              "E0104 4:14 expected a formula after '&&', found ';'\n");
}

// ---- the head of the file

TEST(Head, TheSpecComesFirstAndOnce) {
    EXPECT_EQ(brief(""), "E0107 1:1 the file is empty\n");
    EXPECT_EQ(brief("// nothing\n"), "E0107 2:1 the file is empty\n");
    EXPECT_EQ(brief("let f = a;"), "E0107 1:1 expected 'spec NAME;', found 'let'\n");
    EXPECT_EQ(brief("let f = a;\nspec b;"),
              "E0107 2:1 'spec' must be the first declaration of the file\n");
    EXPECT_EQ(brief("spec a;\nspec b;"), "E0107 2:1 a second 'spec'\n");
    EXPECT_EQ(brief("spec ;"), "E0104 1:6 expected a name after 'spec', found ';'\n");
    EXPECT_EQ(brief("specc a;"), "E0107 1:1 expected 'spec NAME;', found 'specc'\n");
    EXPECT_EQ(brief("x = 1;\nlet f = ;"),
              "E0107 1:1 expected 'spec NAME;', found 'x'\n"
              "E0104 2:9 expected a formula after '=', found ';'\n");
    EXPECT_EQ(brief("specc a;\nspec b;"),
              "E0106 1:1 expected a declaration, found 'specc'\n"
              "E0107 2:1 'spec' must be the first declaration of the file\n");
    EXPECT_EQ(brief("spec G;"), "E0105 1:6 'G' is reserved and cannot be a name\n");
}

TEST(Head, TheFirstSpecNamesTheFile) {
    EXPECT_EQ(Parsed("spec a;\nspec b;").spec.name.text, "a");
    EXPECT_EQ(Parsed("let f = a; spec b;").spec.name.text, "b");
}

// ---- words

TEST(Words, ReservedOnesCannotBeNames) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"X", "it is the operator 'next'"}, {"since", "the operator 'since'"},
        {"and", "the operator '&&'"},       {"target", "a word of the language"},
        {"inf", "a word of the language"},  {"true", "a word of the language"},
        {"U", "the operator 'until'"},      {"load", "a word of the language"},
    };
    for (const auto& [word, note] : cases) {
        EXPECT_EQ(of_line("let " + word + " = p;"),
                  "E0105 2:5 '" + word + "' is reserved and cannot be a name\n");
        EXPECT_EQ(of_line("input q, " + word + " : f32;"),
                  "E0105 2:10 '" + word + "' is reserved and cannot be a name\n");
    }
    EXPECT_NE(Parsed("spec a; let X = p;")
                  .errors()
                  .find("'X' is the operator 'next'; choose another name"),
              std::string::npos);
}

TEST(Words, UnknownKeywordsWithTheNearest) {
    const auto expect = [](const std::string& line, const std::string& said,
                           const std::string& note) {
        const Parsed parsed("spec a;\n" + line);
        EXPECT_EQ(parsed.brief(), said);
        EXPECT_NE(parsed.errors().find("= note: " + note), std::string::npos) << parsed.errors();
    };
    expect("predicat p = x > 1;", "E0106 2:1 expected a declaration, found 'predicat'\n",
           "did you mean 'predicate'?");
    expect("p = x > 1;", "E0106 2:1 expected a declaration, found 'p'\n",
           "a declaration begins with spec,");
    expect(
        "input z : f31;",
        "E0106 2:11 expected a type (f32, f32[D], f16[D], i8[D] or bool) after ':', found 'f31'\n",
        "did you mean 'f32'?");
    expect("rate 20 hz;", "E0106 2:9 expected 'Hz' after '20', found 'hz'\n", "did you mean 'Hz'?");
    expect("period 20 mss;",
           "E0106 2:11 expected a unit of time (us, ms, s or min) after '20', found 'mss'\n",
           "did you mean 'ms'?");
    expect("let f = F[0, 2 mins] a;",
           "E0106 2:16 expected a unit (us, ms, s, min or steps) after '2', found 'mins'\n",
           "did you mean 'min'?");
    expect("const n = 3 mss;",
           "E0106 2:13 expected a unit (us, ms, s, min or steps) after '3', found 'mss'\n",
           "did you mean 'ms'?");
    expect("let f = F[0, 5 a;", "E0104 2:16 expected ']' after '5', found 'a'\n",
           "an interval is written [a, b]");
    expect("let f = b && (F[0 a);", "E0104 2:19 expected ',' after '0', found 'a'\n",
           "an interval is written [a, b]");
    expect("let f = cosin(z, t) < 1;", "E0106 2:9 'cosin' is neither a distance nor a function\n",
           "did you mean 'cosine'?");
    expect("let f = min l3(z, t) < 1;", "E0106 2:13 expected a distance after 'min', found 'l3'\n",
           "did you mean 'l2'?");
    expect("let f = mean lz(z, t) < 1;",
           "E0106 2:14 expected a distance after 'mean', found 'lz'\n", "did you mean 'l2'?");
    expect("let f = mean(z) < 1;", "E0104 2:15 expected an operator or ',' after 'z', found ')'\n",
           "min(...) and max(...) need two or more expressions or, as mean(...), one and a time");
    expect("let f = a until b unti c;",
           "E0104 2:19 expected an operator or ';' after 'b', found 'unti'\n",
           "did you mean 'until'?");
    expect("input z : f32[3] hld 2;", "E0104 2:18 expected ';' after ']', found 'hld'\n",
           "did you mean 'hold'?");
}

// ---- expected words

TEST(Places, MessagesNameWhatWasExpected) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"let = a;", "2:5 expected a name after 'let', found '='"},
        {"let f : a;", "2:7 expected '=' after 'f', found ':'"},
        {"let f = ;", "2:9 expected a formula after '=', found ';'"},
        {"let f = a b;", "2:11 expected an operator or ';' after 'a', found 'b'"},
        {"let f = ! ;", "2:11 expected a formula after '!', found ';'"},
        {"let f = ();", "2:10 expected a formula or an expression after '(', found ')'"},
        {"let f = (a + ) > 1;", "2:14 expected an expression after '+', found ')'"},
        {"let f = x > ;", "2:13 expected a number or an expression after '>', found ';'"},
        {"let f = abs() > 1;", "2:13 expected an expression after '(', found ')'"},
        {"let f = min(x, ) > 1;", "2:16 expected an expression after ',', found ')'"},
        {"let f = min(x) > 1;", "2:14 expected an operator or ',' after 'x', found ')'"},
        {"let f = F[0, ] a;", "2:14 expected a number or inf after ',', found ']'"},
        {"let f = F[-1, 2] a;", "2:11 expected a number or inf after '[', found '-'"},
        {"let f = F[5] a;", "2:12 expected ',' after '5', found ']'"},
        {"let f = l2(3, t) < 1;", "2:13 expected '*' and a point after '3', found ','"},
        {"let f = l2([x, true], t) < 1;",
         "2:16 expected a scalar input or a point after ',', found 'true'"},
        {"let f = l2(z, true) < 1;",
         "2:15 expected the name of a target, or another point after ',', found 'true'"},
        {"let f = l2(true, t) < 1;",
         "2:12 expected the name of an input or a projection, or a vector [x, y] of scalar inputs "
         "after '(', found 'true'"},
        {"let f = l2 z < 1;", "2:12 expected an operator or ';' after 'l2', found 'z'"},
        {"let f = a = b;", "2:11 expected an operator or ';' after 'a', found '='"},
        {"let f = \"a\";", "2:9 expected a formula after '=', found \"a\""},
        {"input z;", "2:8 expected ':' or ',' after 'z', found ';'"},
        {"input z : f16;", "2:14 expected '[' after 'f16', found ';'"},
        {"input z : f32[];", "2:15 expected a number after '[', found ']'"},
        {"input z : f32 in 0, 1;", "2:18 expected '[' after 'in', found '0'"},
        {"input z : f32 in [0, ];", "2:22 expected a number or inf after ',', found ']'"},
        {"const n = x;", "2:11 expected a number after '=', found 'x'"},
        {"period 3;", "2:9 expected a unit of time (us, ms, s or min) after '3', found ';'"},
        {"target t = 3;",
         "2:12 expected load(\"FILE\") or a matrix [[...], ...], 'fitted', 'frames' or 'images' "
         "after '=', found '3'"},
        {"target t = load(t_npy);",
         "2:17 expected a file name between double quotes after '(', found 't_npy'"},
        {"target t = [];",
         "2:13 expected a number, or a row [...] of numbers after '[', found ']'"},
        {"target t = [[1, ]];", "2:17 expected a number after ',', found ']'"},
        {"predicate p = l2(z, t);",
         "2:23 expected a comparison (<=, <, >=, >, == or !=) after ')', found ';'"},
        {"predicate p = a && b;",
         "2:17 expected a comparison (<=, <, >=, >, == or !=) after 'a', found '&&'"},
        {"predicate p = x <= ;",
         "2:20 expected a threshold (a number, an expression or calibrated(...)) after '<=', found "
         "';'"},
        {"predicate p = x <= calibrated(3);",
         "2:31 expected a method of calibration (conformal, risk, class_conditional or f1) after "
         "'(', "
         "found '3'"},
        {"predicate p = x <= calibrated(f1 alpha = 1);",
         "2:34 expected ')' or ',' after 'f1', found 'alpha'"},
        {"predicate p = x <= calibrated(f1, alpha = );",
         "2:43 expected a number or a word after '=', found ')'"},
        {"monitor m = a calibrated(f1) b;",
         "2:30 expected an operator or ';' after ')', found 'b'"},
        {"sliding m = a;", "2:9 expected 'monitor' after 'sliding', found 'm'"},
        {"rate ;", "2:6 expected a number after 'rate', found ';'"},
        {";;;", "2:1 expected a declaration, found ';'"},
    };
    for (const auto& [line, said] : cases) EXPECT_EQ(of_line(line), "E0104 " + said + "\n") << line;
}

TEST(Places, NeverAntlrsOwnWords) {
    // Every prefix of a spec with all features ends in an error in the user's terms.
    const std::string spec =
        "spec a; const k = -2 s; rate 20 Hz; input z : i8[D] scale 0.1 hold n; input x : f32 in "
        "[-1, inf]; target "
        "t = [[1, 2]]; predicate p = kth(2) mahalanobis([1])([x], t) + abs(x) <= calibrated(f1, k "
        "= 2); truth p = x > 1; sliding monitor m = G (p -> F[0s, 2min] !p U x < 1) <-> true "
        "calibrated(f1);";
    for (std::size_t length = 1; length < spec.size(); ++length) {
        const Parsed parsed(spec.substr(0, length));
        const std::string said = parsed.errors();
        for (const char* word :
             {"IDENTIFIER", "NUMBER", "SEMICOLON", "EOF", "mismatched", "viable", "extraneous"})
            EXPECT_EQ(said.find(word), std::string::npos) << said;
        EXPECT_LE(parsed.sink.errors(), 1U) << said;
    }
}

// ---- formulas and expressions

TEST(Kinds, FormulasAndExpressionsAreToldApart) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"let f = x + y;", "E0108 2:9 expected a formula, found an expression"},
        {"let f = -x;", "E0108 2:9 expected a formula, found an expression"},
        {"let f = 3;", "E0108 2:9 expected a formula, found a number"},
        {"let f = a && (3);", "E0108 2:15 expected a formula, found a number"},
        {"let f = min l2(z, t);", "E0108 2:9 expected a formula, found a distance"},
        {"let f = abs(x);", "E0108 2:9 expected a formula, found an expression"},
        {"let f = (a && b) + 1 > 0;", "E0108 2:10 expected an expression, found a formula"},
        {"let f = (a > 1) > 0;", "E0108 2:10 expected an expression, found a formula"},
        {"let f = abs(!a) > 0;", "E0108 2:13 expected an expression, found a formula"},
        {"let f = true + 1 > 0;", "E0108 2:9 expected an expression, found the formula 'true'"},
        {"predicate p = (F a) > 0;", "E0108 2:16 expected an expression, found a formula"},
        {"let f = x < (a && b);", "E0108 2:14 expected an expression, found a formula"},
        {"let f = x == true;", "E0108 2:14 expected an expression, found the formula 'true'"},
        {"let f = 0 < x < 1;", "E0109 2:15 comparisons do not chain"},
        {"let f = x < calibrated(f1);",
         "E0109 2:13 a calibrated threshold is allowed only in a predicate"},
    };
    for (const auto& [line, said] : cases) EXPECT_EQ(of_line(line), said + "\n") << line;
}

// ---- characters

TEST(Characters, UnexpectedOnesWithHints) {
    const auto hint = [](const std::string& line) {
        const std::string said = Parsed("spec a;\n" + line).errors();
        const std::size_t at = said.find("= note: ");
        return at == std::string::npos ? said : said.substr(at + 8, said.find('\n', at) - at - 8);
    };
    EXPECT_EQ(of_line("let f = a ≤ 1;"), "E0102 2:11 unexpected character '≤'\n");
    EXPECT_EQ(hint("let f = a ≤ 1;"), "'less or equal' is '<='");
    EXPECT_EQ(of_line("let f = a $ b;"), "E0102 2:11 unexpected character '$'\n");
    EXPECT_EQ(of_line("let f = a \x01;"), "E0102 2:11 unexpected character U+0001\n");
    EXPECT_EQ(of_line("let f = x <> 1;"), "E0102 2:11 there is no operator '<>'\n");
    EXPECT_EQ(hint("let f = x <> 1;"), "'not equal' is '!='");
    EXPECT_EQ(hint("let f = a & b;"), "'and' is '&&'");
    EXPECT_EQ(hint("let f = a \\/ b;"), "'or' is '||'");
    EXPECT_EQ(hint("let f = a => b;"), "'implies' is '->', 'greater or equal' is '>='");
    EXPECT_EQ(hint("let f := b;"), "a declaration has '=' after its name");
}

TEST(Characters, MalformedNumbers) {
    for (const std::string number : {"1.", ".5", "1e", "1e+", "0x1F", "1.5f"})
        EXPECT_EQ(of_line("let f = x > " + number + ";"),
                  "E0112 2:13 '" + number + "' is not a number\n");
}

TEST(Characters, UnterminatedStringsAndComments) {
    const Parsed parsed(
        "spec a;\ntarget t = load(\"x.npy);\ntarget u = load(\"u.npy\");\nlet f = a; /* open\nlet "
        "g = b;");
    EXPECT_EQ(parsed.brief(),
              "E0103 2:17 this string has no closing '\"' on its line\n"
              "E0103 4:12 this comment has no closing '*/'\n");
    EXPECT_EQ(parsed.tree(), "spec a\n(target u (load \"u.npy\" \"\"))\n(let f a)\n");
    EXPECT_EQ(parsed.spec.unreadable.at(0).text, "t");
}

TEST(Characters, TextThatIsNotUtf8) {
    EXPECT_EQ(of_line("// caf\xE9\nlet f = a && ;"),
              "E0101 2:7 the byte 0xE9 is not UTF-8; save the file as UTF-8\n"
              "E0104 3:14 expected a formula after '&&', found ';'\n");
    EXPECT_EQ(of_line("let f = \xE9;\nlet g = a;"),
              "E0101 2:9 the byte 0xE9 is not UTF-8; save the file as UTF-8\n");
    const Parsed in_string("spec a;\ntarget t = load(\"\x97.npy\");\nlet f = a;");
    EXPECT_EQ(in_string.brief(), "E0101 2:18 the byte 0x97 is not UTF-8; save the file as UTF-8\n");
    EXPECT_EQ(in_string.tree(), "spec a\n(let f a)\n");
    EXPECT_EQ(in_string.spec.unreadable.at(0).text, "t");
    for (const std::string bytes : {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF0\x80\x80\x80",
                                    "\xF5\x80\x80\x80", "\x80", "\xE2\x82", "\xF4\x90\x80\x80"})
        EXPECT_EQ(of_line("//" + bytes).substr(0, 9), "E0101 2:3");
    EXPECT_EQ(brief(std::string("\xFF\xFE", 2) + "s"),
              "E0101 0:0 this file is UTF-16; save it as UTF-8\n");
}

TEST(Characters, NulBytes) {
    EXPECT_EQ(brief(std::string("spec a;\n// \0\nlet", 15)),
              "E0102 2:4 a NUL byte; is this a text file?\n");
}

}  // namespace
