// Tests ast::print: its text parses back to the same tree, and has no redundant bracket; and that
// nothing of a declaration is dropped on the way to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "parse/stream/words.hpp"
#include "parsing.hpp"

namespace {

using namespace etlc;

// ---- canonical form

std::string canonical(const std::string& declaration) {
    const Parsed parsed("spec a; " + declaration);
    EXPECT_EQ(parsed.errors(), "") << declaration;
    return ast::print(parsed.spec).substr(std::string("spec a;\n").size());
}

TEST(Print, CanonicalForm) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"rate 20Hz;", "rate 20 Hz;"},
        {"period 2.50ms;", "period 2.50 ms;"},
        {"rate fps Hz,durations up;", "rate fps Hz, durations up;"},
        {"period step;", "period step;"},
        {"const d=- 2s;", "const d = -2 s;"},
        {"input z:f32[D]hold n;", "input z : f32[D] hold n;"},
        {"input x:f32 in[-top,top];", "input x : f32 in [-top, top];"},
        {"let f=F[a,b s]x>-limit and y==z;", "let f = F[a, b s] (x > -limit) && y == z;"},
        {"input z:f32[2]by net hold 2,stale after 0.5s;",
         "input z : f32[2] by net hold 2, stale after 0.5s;"},
        {"input x:f32 in[0,1],stale after 1 steps;",
         "input x : f32 in [0, 1], stale after 1 step;"},
        {"input a,b:i8[4]scale 0.1 hold 2;", "input a, b : i8[4] scale 0.1 hold 2;"},
        {"input x:f32 in[- 1,inf];", "input x : f32 in [-1, inf];"},
        {"target t=load(\"a.npz\",\"k\");", "target t = load(\"a.npz\", \"k\");"},
        {"target t=[[1,- 2],[3,4]];", "target t = [[1, -2], [3, 4]];"},
        {"predicate p=kth( 2 )mahalanobis([1,2])([x,y],t)<=calibrated( f1,a=- 1,b=c);",
         "predicate p = kth(2) mahalanobis([1, 2])([x, y], t) <= calibrated(f1, a = -1, b = c);"},
        {"truth p=once[0,3]x>-1;", "truth p = O[0, 3] (x > -1);"},
        {"let f=not a and b or c implies d iff e;", "let f = !a && b || c -> d <-> e;"},
        {"let f=((a)until[0s,2 min](b since c));", "let f = a U[0s, 2min] b S c;"},
        {"let f=(a U b)U c;", "let f = (a U b) U c;"},
        {"let f=a && (b && c);", "let f = a && (b && c);"},
        {"let f=!(a && b) -> (c -> d);", "let f = !(a && b) -> c -> d;"},
        {"let f=next(previous(historically(always a)));", "let f = X Y H G a;"},
        {"let f=x-(y-z)*-2/(a*b)>1;", "let f = x - (y - z) * -2 / (a * b) > 1;"},
        {"let f=-(-x)+-(a+b)+-abs((x))>1;", "let f = --x + -(a + b) + -abs(x) > 1;"},
        {"let f=min(max(a,(b)),sqrt(c+d))<2;", "let f = min(max(a, b), sqrt(c + d)) < 2;"},
        {"sliding monitor m=G[0,20]a;", "sliding monitor m = G[0, 20] a;"},
        {"monitor m=F a calibrated(conformal,alpha=0.1);",
         "monitor m = F a calibrated(conformal, alpha = 0.1);"},
        {"drift drift=of level,level=rarely;", "drift drift = of level, level = rarely;"},
    };
    for (const auto& [text, printed] : cases) EXPECT_EQ(canonical(text), printed + "\n");
}

// ---- random trees

/// Random trees of every kind that the parser can build.
class Generator {
public:
    explicit Generator(unsigned seed) : random_(seed) {}

    ast::ExprPtr expression(int depth) {
        using Kind = ast::Expr::Kind;
        auto e = std::make_unique<ast::Expr>();
        e->kind = depth == 0 ? static_cast<Kind>(below(3)) : static_cast<Kind>(below(13));
        const auto arguments = [&](int n) {
            for (int i = 0; i < n; ++i) e->arguments.push_back(expression(depth - 1));
        };
        switch (e->kind) {
            case Kind::number: e->text = number(); break;
            case Kind::name: e->text = name(); break;
            case Kind::distance: e->distance = distance(); break;
            case Kind::past: {
                arguments(1);
                ast::Past past{static_cast<ast::PastKind>(below(4)), nullptr, time()};
                if (past.kind != ast::PastKind::ago) past.time.unit = "s";
                e->past = std::make_unique<ast::Past>(std::move(past));
                break;
            }
            case Kind::negate:
            case Kind::abs:
            case Kind::sqrt: arguments(1); break;
            case Kind::min:
            case Kind::max: arguments(2 + below(2)); break;
            default: arguments(2); break;
        }
        return e;
    }

    ast::FormulaPtr formula(int depth) {
        using Kind = ast::Formula::Kind;
        auto f = std::make_unique<ast::Formula>();
        f->kind = depth == 0 ? static_cast<Kind>(below(4)) : static_cast<Kind>(below(19));
        const auto operands = [&](int n) {
            for (int i = 0; i < n; ++i) f->operands.push_back(formula(depth - 1));
        };
        switch (f->kind) {
            case Kind::constant_true:
            case Kind::constant_false: break;
            case Kind::name: f->name = name(); break;
            case Kind::comparison:
                f->left = expression(depth == 0 ? 1 : depth);
                f->comparison = static_cast<ast::Comparison>(below(6));
                f->right = expression(below(2) != 0 ? 0 : depth);
                break;
            case Kind::conjunction:
            case Kind::disjunction: operands(2 + below(3)); break;
            case Kind::negation:
            case Kind::next:
            case Kind::rise:
            case Kind::fall:
            case Kind::previous: operands(1); break;
            case Kind::held:
                operands(1);
                f->interval = ast::Interval{{{"0", {}}, "", {}}, {{number(), {}}, "s", {}}, {}};
                break;
            case Kind::eventually:
            case Kind::always:
            case Kind::once:
            case Kind::historically:
                operands(1);
                maybe_interval(*f);
                break;
            case Kind::until:
            case Kind::release:
            case Kind::since:
                operands(2);
                maybe_interval(*f);
                break;
            default: operands(2); break;
        }
        return f;
    }

private:
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

    std::string pick(const std::vector<std::string>& from) {
        return from[static_cast<std::size_t>(below(static_cast<int>(from.size())))];
    }

    std::string name() {
        return pick(
            {"a", "b", "goal_a", "s", "min", "max", "l2", "kth", "mean", "abs", "in", "f32", "Hz"});
    }

    std::string number() { return pick({"0", "1", "2.5", "1e-3", "12.0E+4", "007"}); }

    std::unique_ptr<ast::Distance> distance() {
        auto d = std::make_unique<ast::Distance>();
        if (below(2) != 0) {
            ast::Aggregation aggregation;
            aggregation.kind = static_cast<ast::Aggregation::Kind>(below(4));
            if (aggregation.kind == ast::Aggregation::Kind::kth)
                aggregation.n = ast::Number{"2", {}};
            d->aggregation = aggregation;
        }
        d->metric.text = pick({"l2", "l2sq", "l1", "linf", "cosine", "angular", "mahalanobis"});
        if (d->metric.text == "mahalanobis") d->weights = weights();
        d->point = point();
        d->other = below(2) != 0 ? named_point() : point();
        return d;
    }

    ast::Point point() {
        ast::Point point = named_point();
        if (below(3) == 0) point.parts.push_back(this->point());
        if (below(3) == 0) {
            point = {};
            point.is_vector = true;
            for (int i = 1 + below(3); i > 0; --i)
                point.parts.push_back(below(3) == 0 ? this->point() : named_point());
        }
        if (below(4) == 0) point.delays.push_back(time());
        return point;
    }

    ast::Point named_point() {
        ast::Point point;
        point.name.text = name();
        return point;
    }

    ast::Bound time() { return {{pick({"1", "2.5", "30"}), {}}, pick({"", "ms", "s", "min"}), {}}; }

    ast::Fitted fitted() {
        ast::Fitted fitted;
        fitted.method.text = name();
        fitted.arguments.push_back({{"of", {}}, point()});
        if (below(2) != 0) fitted.arguments.push_back({{"k", {}}, ast::Number{"8", {}}});
        return fitted;
    }

    ast::Weights weights() {
        switch (below(5)) {
            case 0: return ast::Load{"w.npy", below(2) != 0 ? "key" : "", {}, {}, {}};
            case 1:
                return ast::MatrixLiteral{{{{"1", {}}, {"-2", {}}}, {{"3", {}}, {"4", {}}}}, {}};
            case 2: return ast::VectorLiteral{{{"1", {}}, {"-2", {}}}, {}};
            case 3: return fitted();
            default: return ast::Name{name(), {}};
        }
    }

    void maybe_interval(ast::Formula& f) {
        if (below(2) == 0) return;
        const auto bound = [this] {
            const std::string unit = pick({"", "us", "ms", "s", "min", "steps", "inf"});
            const std::string constant = name();
            if (below(4) == 0)
                return ast::Bound{{constant, {}, constant}, unit == "inf" ? "" : unit, {}};
            return unit == "inf" ? ast::Bound{{"inf", {}}, "", {}}
                                 : ast::Bound{{number(), {}}, unit, {}};
        };
        f.interval = ast::Interval{bound(), bound(), {}};
    }

    std::mt19937 random_;
};

TEST(Print, RandomFormulasReadBackAsTheyWere) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const ast::FormulaPtr formula = Generator(seed).formula(1 + static_cast<int>(seed % 5));
        const std::string printed = ast::print(*formula);
        ASSERT_EQ(tree_of_formula(printed), tree_text::of(*formula)) << printed;
    }
}

TEST(Print, RandomExpressionsReadBackAsTheyWere) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const ast::ExprPtr expression = Generator(seed).expression(1 + static_cast<int>(seed % 5));
        const std::string printed = ast::print(*expression);
        ASSERT_EQ(tree_of_expression(printed), tree_text::of(*expression)) << printed;
    }
}

/// Returns `text` without the bracket at `open` and its partner; empty if it is not a grouping
/// bracket.
std::string without_brackets(const std::string& text, std::size_t open) {
    const bool call = open > 0 && (std::isalnum(static_cast<unsigned char>(text[open - 1])) != 0 ||
                                   text[open - 1] == ')' || text[open - 1] == '_');
    if (text[open] != '(' || call) return {};
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
        depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        if (depth == 0)
            return text.substr(0, open) + text.substr(open + 1, i - open - 1) + text.substr(i + 1);
    }
    return {};
}

TEST(Print, NoBracketCouldBeLeftOut) {
    // Except those of a comparison under a prefix operator, which help the reader.
    const auto compared = [](const std::string& text, std::size_t open) {
        const std::string inner = text.substr(open, text.find(')', open) - open);
        const bool prefixed =
            open > 0 && (text[open - 1] == '!' || text[open - 1] == ' ' || text[open - 1] == ']');
        return prefixed &&
               (inner.find('<') != std::string::npos || inner.find('>') != std::string::npos ||
                inner.find('=') != std::string::npos ||
                inner.find_first_of("+-*/(", 1) != std::string::npos);
    };
    int tried = 0;
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const ast::FormulaPtr formula = Generator(seed).formula(4);
        const std::string printed = ast::print(*formula);
        for (std::size_t i = 0; i < printed.size(); ++i) {
            const std::string fewer = without_brackets(printed, i);
            if (fewer.empty() || compared(printed, i)) continue;
            ++tried;
            ASSERT_NE(tree_of_formula(fewer), tree_text::of(*formula)) << printed << "\n" << fewer;
        }
    }
    EXPECT_GT(tried, 1000);
}

TEST(Print, WholeSpecsReadBackAsTheyWere) {
    const Parsed parsed(
        "spec a; rate 20 Hz; period 3 ms; input z : f16[3] hold 2; input x, y : f32 in [0, 1]; "
        "input b : bool; target t = load(\"t.npy\"); target u = [[1, 2]]; target v = [1]; "
        "predicate p = min l1(z, t) <= 1; predicate q = x > calibrated(conformal, alpha = 0.10); "
        "truth q = H (x > 1); let f = p && q; monitor m = F f; monitor n = G f "
        "calibrated(conformal, alpha = 0.1); sliding monitor k = F[0, 3] f;");
    ASSERT_EQ(parsed.errors(), "");
    const Parsed again(ast::print(parsed.spec));
    EXPECT_EQ(again.errors(), "");
    EXPECT_EQ(again.tree(), parsed.tree());
    EXPECT_EQ(ast::print(again.spec), ast::print(parsed.spec));
}

// ---- nothing is dropped

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// The specs of the folders, and those on pages.
std::vector<std::string> corpus() {
    std::vector<std::string> texts;
    const std::regex on_page("```etl[^\n]*\n([^`]*)```");
    for (const char* folder : {"docs", "examples", "tests"}) {
        const fs::path root = fs::path(ETLC_SOURCE_DIR) / folder;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
            const fs::path& path = entry.path();
            if (path.extension() == ".etl") texts.push_back(content_of(path));
            if (path.extension() != ".md") continue;
            const std::string page = content_of(path);
            for (std::sregex_iterator at(page.begin(), page.end(), on_page), end; at != end; ++at)
                texts.push_back((*at)[1]);
        }
    }
    return texts;
}

/// The words of a declaration without its ';'.
using Words = std::vector<std::string>;

/// Returns one declaration of each form in the corpus: other names and numbers are no other form.
std::vector<Words> forms_of_declarations() {
    std::vector<Words> forms;
    std::set<std::string> known;
    for (std::string& text : corpus()) {
        const source::File file("", std::move(text));
        Words words;
        std::string form;
        for (const parse::Word& word : parse::words_of(file)) {
            const std::string written(file.text(word.span));
            if (written == ";") {
                if (known.insert(form).second) forms.push_back(words);
                words.clear();
                form.clear();
                continue;
            }
            using Kind = parse::Word::Kind;
            words.push_back(written);
            form += word.kind == Kind::name     ? "n"
                    : word.kind == Kind::number ? "0"
                    : word.kind == Kind::string ? "\"\""
                                                : written;
            form += ' ';
        }
    }
    return forms;
}

/// Returns the declaration as printed; nothing if it is refused.
std::optional<std::string> printed(const Words& words, std::size_t from = 0, std::size_t to = 0) {
    std::string text = "spec a; ";
    for (std::size_t i = 0; i < words.size(); ++i)
        if (i < from || i >= to) text += words[i] + ' ';
    const Parsed parsed(text + ';');
    if (parsed.sink.has_errors() || parsed.spec.declarations.size() != 1) return std::nullopt;
    return ast::print(parsed.spec);
}

int depth_of(const std::string& word) {
    return word == "(" || word == "[" ? 1 : word == ")" || word == "]" ? -1 : 0;
}

/// Every optional piece of the grammar is a run of words with whole brackets, as is every operand
/// or element that may be left out. Where the rest is a declaration, it is another one.
TEST(Declarations, LoseAWordOnlyByAnError) {
    constexpr std::size_t kLongest = 8;
    const std::vector<Words> forms = forms_of_declarations();
    EXPECT_GT(forms.size(), 800U);
    int shorter = 0;
    for (const Words& words : forms) {
        const auto whole = printed(words);
        if (!whole) continue;
        for (std::size_t from = 0; from < words.size(); ++from) {
            int depth = 0;
            for (std::size_t to = from + 1; to <= std::min(words.size(), from + kLongest); ++to) {
                depth += depth_of(words[to - 1]);
                if (depth < 0) break;
                if (depth > 0) continue;
                const auto rest = printed(words, from, to);
                shorter += rest ? 1 : 0;
                if (rest == whole)
                    ADD_FAILURE() << *whole << "says nothing of words " << from << " to " << to - 1;
            }
        }
    }
    EXPECT_GT(shorter, 5000);
}

}  // namespace
