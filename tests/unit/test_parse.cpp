// Tests valid specs: every declaration, precedence and associativity of every pair of operators,
// contextual words.
#include <gtest/gtest.h>

#include "parsing.hpp"

namespace {

using namespace etlc;

// ---- declarations

TEST(Declarations, EachForm) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"rate 20 Hz;", "(rate 20 Hz)"},
        {"period 2.5 ms;", "(period 2.5 ms)"},
        {"period 1 min;", "(period 1 min)"},
        {"input z : f32[32];", "(input z :f32 (dimension 32))"},
        {"input z : f16[32];", "(input z :f16 (dimension 32))"},
        {"input z : i8[32];", "(input z :i8 (dimension 32))"},
        {"input z : i8[32] scale 0.05 hold 3;",
         "(input z :i8 (dimension 32) (scale 0.05) (hold 3))"},
        {"input z : f32[2] by net hold 2, stale after 5;",
         "(input z :f32 (dimension 2) (by net) (hold 2) (stale 5))"},
        {"input stale, after : f32, stale after after ms;",
         "(input stale after :f32 (stale afterms))"},
        {"input a, b : bool hold 1;", "(input a b :bool (hold 1))"},
        {"input g : f32 in [0, 1];", "(input g :f32 (range 0 1))"},
        {"input g : f32 in [-inf, inf] hold 2;", "(input g :f32 (range -inf inf) (hold 2))"},
        {"input g : f32 in [ - 1e-3, 2.5E+7 ];", "(input g :f32 (range -1e-3 2.5E+7))"},
        {"target t = load(\"a/b.npy\");", "(target t (load \"a/b.npy\" \"\"))"},
        {"target t = load(\"b.npz\", \"key\");", "(target t (load \"b.npz\" \"key\"))"},
        {"target t = load(\"C:\\n\\t.npy\");", "(target t (load \"C:\\n\\t.npy\" \"\"))"},
        {"target t = [[1, -2], [3, 4]];", "(target t (matrix (vector 1 -2) (vector 3 4)))"},
        {"target t = [[1]];", "(target t (matrix (vector 1)))"},
        {"target t = [1, -2];", "(target t (vector 1 -2))"},
        {"predicate p = x > 0.5;", "(predicate p > x 0.5)"},
        {"predicate p = x >= - 2;", "(predicate p >= x (negate 2))"},
        {"predicate p = x < calibrated(f1);", "(predicate p < x (calibrated f1))"},
        {"predicate p = l2(z, t) <= calibrated(conformal, alpha = 0.10, mode = strict, x = -1);",
         "(predicate p <= (distance l2 (input z) t) (calibrated conformal (alpha 0.10) (mode "
         "strict) (x -1)))"},
        {"truth p = l2([px, py], t) < 0.25;", "(truth p (< (distance l2 (vector px py) t) 0.25))"},
        {"let f = !p;", "(let f (! p))"},
        {"monitor m = F p;", "(monitor m (F p))"},
        {"sliding monitor m = F[0, 2] p;", "(sliding m (F [0,2] p))"},
        {"monitor m = F p calibrated(conformal, alpha = 0.1);",
         "(monitor m (F p) (calibrated conformal (alpha 0.1)))"},
    };
    for (const auto& [text, tree] : cases) EXPECT_EQ(tree_of_declaration(text), tree) << text;
}

TEST(Declarations, StandInFileOrderWithTheirSpans) {
    const Parsed parsed("spec a;\nlet g = p;  // g\nrate 20 Hz;\n/* no */ let f = (p) && q ;");
    EXPECT_EQ(parsed.errors(), "");
    EXPECT_EQ(parsed.tree(), "spec a\n(let g p)\n(rate 20 Hz)\n(let f (&& p q))\n");
    const auto& f = std::get<ast::Let>(parsed.spec.declarations[2]);
    EXPECT_EQ(parsed.file.text(f.span), "let f = (p) && q");
    EXPECT_EQ(parsed.file.text(f.formula->span), "(p) && q");
    EXPECT_EQ(parsed.file.text(f.formula->operator_span), "&&");
    EXPECT_EQ(parsed.file.text(f.formula->operands[0]->span), "p");
    EXPECT_EQ(parsed.file.text(parsed.spec.name.span), "a");
}

TEST(Declarations, SpansInsideDistances) {
    const Parsed parsed(
        "spec a; predicate p = kth(2) mahalanobis(load(\"w.npz\", \"k\"))([x, y], t) - 1 <= -2;");
    ASSERT_EQ(parsed.errors(), "");
    const auto& p = std::get<ast::Predicate>(parsed.spec.declarations[0]);
    const auto text = [&parsed](source::Span span) { return std::string(parsed.file.text(span)); };
    EXPECT_EQ(text(p.expression->span),
              "kth(2) mahalanobis(load(\"w.npz\", \"k\"))([x, y], t) - 1");
    const ast::Distance& d = *p.expression->arguments[0]->distance;
    EXPECT_EQ(text(d.span), "kth(2) mahalanobis(load(\"w.npz\", \"k\"))([x, y], t)");
    EXPECT_EQ(text(d.aggregation->span), "kth(2)");
    EXPECT_EQ(text(d.metric.span), "mahalanobis");
    EXPECT_EQ(text(d.point.span), "[x, y]");
    EXPECT_EQ(text(d.other.span), "t");
    const auto& load = std::get<ast::Load>(*d.weights);
    EXPECT_EQ(text(load.span), "load(\"w.npz\", \"k\")");
    EXPECT_EQ(text(load.path_span), "\"w.npz\"");
    EXPECT_EQ(text(load.key_span), "\"k\"");
    EXPECT_EQ(text(std::get<ast::ExprPtr>(p.threshold)->span), "-2");
}

TEST(Declarations, BlanksCommentsAndLineEndsDoNotMatter) {
    const std::string tree = "spec a\n(let f (F [0,2] (&& p q)))\n";
    EXPECT_EQ(Parsed("spec a;let f=F[0,2](p&&q);").tree(), tree);
    EXPECT_EQ(Parsed("\xEF\xBB\xBFspec a;\r\n\tlet f\r\n=F [ 0 , 2 ]\f( p // (\r\n && q ) ; // end")
                  .tree(),
              tree);
    EXPECT_EQ(
        Parsed("/**/spec/* ; */a;/***/let f = /* two\nlines // */ F[0,2] (p and q);//").tree(),
        tree);
    EXPECT_EQ(Parsed("spec a; // 目标 ≤\nlet f = F[0,2] (p && q);").errors(), "");
}

// ---- formulas

struct Binary {
    std::string symbol;
    std::string word;
    int level;  ///< of the table in docs/language.md; larger binds tighter
    enum { left, right, n_ary } associates;
};

const std::vector<Binary> kBinary{
    {"<->", "iff", 1, Binary::left},    {"->", "implies", 2, Binary::right},
    {"||", "or", 3, Binary::n_ary},     {"&&", "and", 4, Binary::n_ary},
    {"U", "until", 5, Binary::right},   {"W", "weak_until", 5, Binary::right},
    {"R", "release", 5, Binary::right}, {"S", "since", 5, Binary::right},
};

const std::vector<std::pair<std::string, std::string>> kPrefix{
    {"!", "not"},  {"X", "next"},         {"F", "eventually"}, {"G", "always"},  {"Y", "previous"},
    {"O", "once"}, {"H", "historically"}, {"rise", "rise"},    {"fall", "fall"},
};

std::string tree(const std::string& op, const std::string& a, const std::string& b) {
    return "(" + op + " " + a + " " + b + ")";
}

/// Returns the required meaning of `a op1 b op2 c`.
std::string expected_tree(const Binary& first, const Binary& second) {
    const bool to_the_left = first.level != second.level ? first.level > second.level
                                                         : first.associates != Binary::right;
    if (first.symbol == second.symbol && first.associates == Binary::n_ary)
        return "(" + first.symbol + " a b c)";
    if (to_the_left) return tree(second.symbol, tree(first.symbol, "a", "b"), "c");
    return tree(first.symbol, "a", tree(second.symbol, "b", "c"));
}

TEST(Formulas, EveryPairOfBinaryOperators) {
    for (const Binary& first : kBinary) {
        for (const Binary& second : kBinary) {
            const std::string tree = expected_tree(first, second);
            EXPECT_EQ(tree_of_formula("a " + first.symbol + " b " + second.symbol + " c"), tree);
            EXPECT_EQ(tree_of_formula("a " + first.word + " b " + second.word + " c"), tree);
        }
    }
}

TEST(Formulas, BracketsOverrideEveryPair) {
    for (const Binary& first : kBinary) {
        for (const Binary& second : kBinary) {
            const std::string& one = first.symbol;
            const std::string& two = second.symbol;
            EXPECT_EQ(tree_of_formula("(a " + one + " b) " + two + " c"),
                      tree(two, tree(one, "a", "b"), "c"));
            EXPECT_EQ(tree_of_formula("a " + one + " (b " + two + " c)"),
                      tree(one, "a", tree(two, "b", "c")));
        }
    }
}

TEST(Formulas, PrefixOperatorsBindTighterThanEveryBinaryOne) {
    for (const auto& [symbol, word] : kPrefix) {
        const std::string prefixed = "(" + symbol + " a)";
        for (const Binary& op : kBinary) {
            EXPECT_EQ(tree_of_formula(symbol + " a " + op.symbol + " b"),
                      tree(op.symbol, prefixed, "b"));
            EXPECT_EQ(tree_of_formula(word + " a " + op.word + " b"),
                      tree(op.symbol, prefixed, "b"));
            EXPECT_EQ(tree_of_formula("b " + op.symbol + " " + symbol + " a"),
                      tree(op.symbol, "b", prefixed));
        }
        for (const auto& [inner, inner_word] : kPrefix) {
            EXPECT_EQ(tree_of_formula(symbol + " " + inner + " a"),
                      "(" + symbol + " (" + inner + " a))");
            EXPECT_EQ(tree_of_formula(word + " " + inner_word + " a"),
                      "(" + symbol + " (" + inner + " a))");
        }
        EXPECT_EQ(tree_of_formula(symbol + " x > 1"), "(" + symbol + " (> x 1))");
    }
}

TEST(Formulas, IntervalsWhereTheyAreAllowed) {
    for (const std::string op : {"F", "G", "O", "H"})
        EXPECT_EQ(tree_of_formula(op + "[1, 2] " + op + "[0, inf] a"),
                  "(" + op + " [1,2] (" + op + " [0,inf] a))");
    for (const std::string op : {"U", "R", "S"})
        EXPECT_EQ(tree_of_formula("a " + op + "[1, 2] b " + op + "[0s, 3min] c"),
                  "(" + op + " [1,2] a (" + op + " [0s,3min] b c))");
    for (const std::string op : {"!", "X", "Y"})
        EXPECT_NE(tree_of_formula(op + "[1, 2] a").find("takes no interval"), std::string::npos);
    for (const std::string op : {"W", "&&", "||", "->", "<->"})
        EXPECT_NE(tree_of_formula("a " + op + "[1, 2] b").find("takes no interval"),
                  std::string::npos);
}

TEST(Formulas, Bounds) {
    EXPECT_EQ(tree_of_formula("F[0us, 5ms] a"), "(F [0us,5ms] a)");
    EXPECT_EQ(tree_of_formula("F[0, 2 s] a"), "(F [0,2s] a)");
    EXPECT_EQ(tree_of_formula("F[0.5s, 1e3min] a"), "(F [0.5s,1e3min] a)");
    EXPECT_EQ(tree_of_formula("F[inf, inf] a"), "(F [inf,inf] a)");
}

TEST(Formulas, Atoms) {
    EXPECT_EQ(tree_of_formula("true"), "true");
    EXPECT_EQ(tree_of_formula("((false))"), "false");
    EXPECT_EQ(tree_of_formula("(((a)))"), "a");
    EXPECT_EQ(tree_of_formula("x > -1"), "(> x (negate 1))");
    EXPECT_EQ(tree_of_formula("x>-1&&y<=2"), "(&& (> x (negate 1)) (<= y 2))");
    EXPECT_EQ(tree_of_formula("(x) > 1"), "(> x 1)");
    EXPECT_EQ(tree_of_formula("((x)) + (y) >= 1"), "(>= (+ x y) 1)");
    EXPECT_EQ(tree_of_formula("(x + y) * 2 > 1"), "(> (* (+ x y) 2) 1)");
    EXPECT_EQ(tree_of_formula("(a && b)"), "(&& a b)");
    EXPECT_EQ(tree_of_formula("((x + y) * 2 > 1 && (b))"), "(&& (> (* (+ x y) 2) 1) b)");
    EXPECT_EQ(tree_of_formula("abs(x - y) + 0.5 * max(x, y) <= 1.5"),
              "(<= (+ (abs (- x y)) (* 0.5 (max x y))) 1.5)");
    EXPECT_EQ(tree_of_formula("min l2(z, t) - min l2(z, u) <= 0.02"),
              "(<= (- (distance min l2 (input z) t) (distance min l2 (input z) u)) 0.02)");
    EXPECT_EQ(tree_of_formula("F a && G x < 1 || -x + 1 > 2"),
              "(|| (&& (F a) (G (< x 1))) (> (+ (negate x) 1) 2))");
}

TEST(Formulas, LongAndOrAreOneNode) {
    const Parsed parsed("spec a; let f = a && b && (c && d) && e || f || (g || h);");
    EXPECT_EQ(parsed.tree(), "spec a\n(let f (|| (&& a b (&& c d) e) f (|| g h)))\n");
}

// ---- expressions

TEST(Expressions, EveryPairOfOperators) {
    const std::vector<std::pair<std::string, int>> operators{
        {"+", 1}, {"-", 1}, {"*", 2}, {"/", 2}};
    for (const auto& [first, first_level] : operators) {
        for (const auto& [second, second_level] : operators) {
            const std::string text = "a " + first + " b " + second + " c";
            const std::string expected = first_level >= second_level
                                             ? tree(second, tree(first, "a", "b"), "c")
                                             : tree(first, "a", tree(second, "b", "c"));
            EXPECT_EQ(tree_of_expression(text), expected) << text;
        }
        EXPECT_EQ(tree_of_expression("-a " + first + " -b"),
                  tree(first, "(negate a)", "(negate b)"));
    }
}

TEST(Expressions, Signs) {
    EXPECT_EQ(tree_of_expression("-3"), "(negate 3)");
    EXPECT_EQ(tree_of_expression("- -x"), "(negate (negate x))");
    EXPECT_EQ(tree_of_expression("1--2"), "(- 1 (negate 2))");
    EXPECT_EQ(tree_of_expression("-(a + b)"), "(negate (+ a b))");
}

TEST(Expressions, Functions) {
    EXPECT_EQ(tree_of_expression("abs(a)"), "(abs a)");
    EXPECT_EQ(tree_of_expression("sqrt(a * a + b)"), "(sqrt (+ (* a a) b))");
    EXPECT_EQ(tree_of_expression("min(a, b, -c)"), "(min a b (negate c))");
    EXPECT_EQ(tree_of_expression("max(min l2(z, t), max(a, 1))"),
              "(max (distance min l2 (input z) t) (max a 1))");
}

TEST(Expressions, EveryDistance) {
    for (const std::string metric : {"l2", "l2sq", "l1", "linf", "cosine", "angular"}) {
        const std::string plain = metric + "(z, t)";
        EXPECT_EQ(tree_of_expression(plain), "(distance " + metric + " (input z) t)");
        for (const std::string aggregation : {"min", "max", "mean"})
            EXPECT_EQ(tree_of_expression(aggregation + " " + plain),
                      "(distance " + aggregation + " " + metric + " (input z) t)");
        EXPECT_EQ(tree_of_expression("kth(3) " + plain),
                  "(distance kth 3 " + metric + " (input z) t)");
    }
}

TEST(Expressions, EveryKindOfWeights) {
    const auto weighted = [](const std::string& w) {
        return tree_of_expression("mean mahalanobis(" + w + ")([x, y], t)");
    };
    const auto expected = [](const std::string& w) {
        return "(distance mean mahalanobis (weights " + w + ") (vector x y) t)";
    };
    EXPECT_EQ(weighted("load(\"w.npy\")"), expected("(load \"w.npy\" \"\")"));
    EXPECT_EQ(weighted("[[1, 0], [0, -2]]"), expected("(matrix (vector 1 0) (vector 0 -2))"));
    EXPECT_EQ(weighted("[1, 2]"), expected("(vector 1 2)"));
    EXPECT_EQ(weighted("w"), expected("w"));
}

// ---- contextual words

TEST(ContextualWords, AreNamesWhereTheyCannotBeKeywords) {
    for (const std::string word :
         {"in",   "hold",   "stale",   "after", "scale",     "f32",         "f16",   "i8",
          "bool", "steps",  "step",    "Hz",    "us",        "ms",          "s",     "min",
          "max",  "mean",   "kth",     "l2",    "l2sq",      "l1",          "linf",  "abs",
          "sqrt", "cosine", "angular", "f1",    "conformal", "mahalanobis", "alpha", "x"}) {
        EXPECT_EQ(tree_of_declaration("input " + word + " : f32 in [0, 1] hold 2;"),
                  "(input " + word + " :f32 (range 0 1) (hold 2))");
        EXPECT_EQ(tree_of_formula(word), word);
        EXPECT_EQ(tree_of_formula("F[0, 2] " + word), "(F [0,2] " + word + ")");
        EXPECT_EQ(tree_of_formula(word + " > 1"), "(> " + word + " 1)");
        EXPECT_EQ(tree_of_formula("(" + word + " - " + word + ") > 1"),
                  "(> (- " + word + " " + word + ") 1)");
        EXPECT_EQ(tree_of_expression("min l2(" + word + ", " + word + ")"),
                  "(distance min l2 (input " + word + ") " + word + ")");
        EXPECT_EQ(tree_of_expression("mahalanobis(" + word + ")([" + word + "], t)"),
                  "(distance mahalanobis (weights " + word + ") (vector " + word + ") t)");
    }
}

TEST(ContextualWords, UnitsAfterNumbersAndNamesElsewhere) {
    EXPECT_EQ(tree_of_formula("G (s -> F[0s, 2min] min)"), "(G (-> s (F [0s,2min] min)))");
    EXPECT_EQ(tree_of_formula("min l2(min, max) + min(min, max) < 1"),
              "(< (+ (distance min l2 (input min) max) (min min max)) 1)");
}

TEST(ContextualWords, LongerWordsAreNames) {
    EXPECT_EQ(tree_of_formula("Fa && G_ || notable"), "(|| (&& Fa G_) notable)");
}

}  // namespace
