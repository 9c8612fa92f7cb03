// Notation of other tools gives one error, which shows the notation of this language.
#include <gtest/gtest.h>

#include "checking.hpp"

namespace {

using namespace etlc;

struct Case {
    const char* written;
    const char* cure;
};

constexpr const char* kHead =
    "spec a;\n"
    "input x, y : f32; input p, q, r : bool; input z : f32[2];\n"
    "target goal = [[1, 2]]; predicate near = l2(z, goal) <= 1;\n"
    "monitor other = G (near || p || q || r || x < y);\n";

std::string said_of(const std::string& line, const char* head = kHead) {
    const Checked checked(std::string(head) + line + "\n");
    EXPECT_EQ(checked.sink.errors(), 1U) << line << "\n" << checked.diagnostics();
    return checked.diagnostics();
}

template <class Cases, class Line>
void expect_cures(const Cases& cases, const Line& line_of) {
    for (const Case& one : cases) {
        const std::string said = said_of(line_of(one.written));
        EXPECT_NE(said.find(one.cure), std::string::npos) << one.cure << "\n" << said;
    }
}

std::string in_formula(const std::string& formula) {
    return "monitor m = " + formula + ";";
}
std::string alone(const std::string& line) {
    return line;
}

TEST(Foreign, Operators) {
    constexpr Case kCases[] = {
        // LTL and MTL, as papers and SPIN, Spot, NuSMV, SPOT write them
        {"finally p", "'eventually' is 'F'"},
        {"finally (p)", "'eventually' is 'F'"},
        {"finally[0, 2] p", "'eventually' is 'F'"},
        {"q && Finally p", "'eventually' is 'F'"},
        {"globally p", "'always' is 'G'"},
        {"P p", "'once' is 'O'"},
        {"P[0, 2] p", "'once' is 'O'"},
        {"prev p", "'previous' is 'Y'"},
        {"alw_[0, 2] p", "the interval follows the operator: G[0, 2 s]"},
        {"<> p", "'eventually' is 'F'"},
        {"<>[0, 2] p", "'eventually' is 'F'"},
        {"(<> p) && q", "'eventually' is 'F'"},
        {"[] p", "'always' is 'G'"},
        {"q -> [] p", "'always' is 'G'"},
        {"[](p -> q)", "'always' is 'G'"},
        {"x <> y", "'not equal' is '!='"},
        {"◇ p", "'eventually' is 'F'"},
        {"◊ p", "'eventually' is 'F'"},
        {"□ p", "'always' is 'G'"},
        {"¬p", "'not' is '!'"},
        {"p ∧ q", "'and' is '&&'"},
        {"p ∨ q", "'or' is '||'"},
        {"p ⇒ q", "'implies' is '->'"},
        {"p ⟹ q", "'implies' is '->'"},
        {"p ⇔ q", "'if and only if' is '<->'"},
        {"⊤", "true"},
        {"x ≤ y", "'<='"},
        {"x ≠ y", "'!='"},
        {"p 𝒰 q", "'until' is 'U'"},
        {"GF p", "'G F'"},
        {"GF (p)", "'G F'"},
        {"Gp", "did you mean 'G p'?"},
        {"GFp", "did you mean 'G F p'?"},
        {"p V q", "'release' is 'R'"},
        {"p M q", "'g U (f && g)'"},
        {"p unless q", "'weak until' is 'W'"},
        {"p xor q", "'!(f <-> g)'"},
        {"p ^ q", "'!(f <-> g)'"},
        {"p AND q", "did you mean '&&'?"},
        {"p Or q", "did you mean '||'?"},
        {"NOT p", "did you mean '!'?"},
        {"Always p", "did you mean 'G'?"},
        {"EVENTUALLY p", "did you mean 'F'?"},
        {"p Until q", "did you mean 'U'?"},
        {"p & q", "'and' is '&&'"},
        {"p /\\ q", "'and' is '&&'"},
        {"p \\/ q", "'or' is '||'"},
        {"p | q", "'or' is '||'"},
        {"|x| < 1", "abs(x)"},
        {"~p", "'not' is '!'"},
        {"p => q", "'implies' is '->'"},
        {"p --> q", "'implies' is '->'"},
        {"p <=> q", "'<->'"},
        {"x = 1", "'=='"},
        {"TRUE", "did you mean 'true'?"},
        {"G (p -> False)", "did you mean 'false'?"},
        {"G {p}", "( )"},
        {"x > .5", "did you mean '0.5'?"},
        {"x > 5.", "did you mean '5.0'?"},
        {"x > 0.5f", "did you mean '0.5'?"},
        {"p\u00a0&& q", "no-break space"},
        {"p && é", "ASCII"},
        {"x % 2 == 0", "//"},
    };
    expect_cures(kCases, in_formula);
}

TEST(Foreign, Intervals) {
    constexpr Case kCases[] = {
        {"F[0..2] p", "bounds are separated by a comma"},
        {"F[0..2s] p", "bounds are separated by a comma"},
        {"F[0 .. 2] p", "bounds are separated by a comma"},
        {"F[0.0..2.5] p", "bounds are separated by a comma"},
        {"F[0…2] p", "bounds are separated by a comma"},
        {"F[0:2] p", "bounds are separated by a comma"},
        {"eventually[0:2](x > 3)", "bounds are separated by a comma"},
        {"F[0 - 2] p", "bounds are separated by a comma"},
        {"F[0-2] p", "bounds are separated by a comma"},
        {"F[0 2] p", "bounds are separated by a comma"},
        {"F[0 to 2] p", "bounds are separated by a comma"},
        {"p U[0:2] q", "bounds are separated by a comma"},
        {"H[:10] p", "an interval needs both bounds"},
        {"H[,10] p", "an interval needs both bounds"},
        {"F[<=5] p", "an interval needs both bounds"},
        {"F[2] p", "an interval needs both bounds: [0, 2]"},
        {"F[2,] p", "[a, inf]"},
        {"F[0, 2) p", "an interval includes both bounds"},
        {"F(0, 2) p", "square brackets"},
        {"F{0, 2} p", "square brackets"},
        {"F_{0, 2} p", "square brackets"},
        {"p U_{0, 2} q", "square brackets"},
        {"F_[0, 2] p", "F[0, 2 s]"},
        {"G F_[0, 2] p", "F[0, 2 s]"},
        {"p U_[0, 2] q", "U[0, 2 s]"},
        {"always_[0, 2] p", "always[0, 2 s]"},
        {"F_I p", "F[0, 2 s]"},
        {"p U_I q", "U[0, 2 s]"},
        {"F<=2 p", "F[0, 2 s]"},
        {"F[0, ∞] p", "inf"},
        {"F[0, infinity] p", "did you mean 'inf'?"},
        {"F[0, 2 sec] p", "did you mean 's'?"},
        {"F[0, 2 seconds] p", "did you mean 's'?"},
        {"F[0, 2 S] p", "did you mean 's'?"},
        {"F[0, 2 msec] p", "did you mean 'ms'?"},
        {"F[0, 2 m] p", "did you mean 'min'?"},
        {"F[0, 2 h] p", "an hour is 60 min"},
        {"F[0, 2 frames] p", "did you mean 'steps'?"},
        {"held[2 sec] p", "did you mean 's'?"},
        {"F[0, 5 µs] p", "'us'"},
        {"F[0, 2]s p", "the unit follows the bound"},
        {"held[0, 2] p", "held[2 s] f"},
    };
    expect_cures(kCases, in_formula);
}

TEST(Foreign, Declarations) {
    constexpr Case kCases[] = {
        {"G p;", "monitor NAME = FORMULA;"},
        {"[] p;", "monitor NAME = FORMULA;"},
        {"rate = 10 Hz;", "rate 10 Hz;"},
        {"rate: 10 Hz;", "rate 10 Hz;"},
        {"rate 10;", "'Hz'"},
        {"rate 10 fps;", "did you mean 'Hz'?"},
        {"rate 10 hz;", "did you mean 'Hz'?"},
        {"rate 1 kHz;", "1000 Hz"},
        {"period = 50 ms;", "period 50 ms;"},
        {"period 50 msec;", "did you mean 'ms'?"},
        {"input f32 u;", "input x : f32;"},
        {"input u = f32;", "input x : f32;"},
        {"input u : float;", "did you mean 'f32'?"},
        {"input u : Bool;", "did you mean 'bool'?"},
        {"input u : f32 hold = 3;", "hold 3 steps"},
        {"input u : f32 hold 3 frames;", "did you mean 'steps'?"},
        {"INPUT u : f32;", "did you mean 'input'?"},
        {"var u : bool;", "did you mean 'input'?"},
        {"define f = p;", "did you mean 'let'?"},
        {"let f := p;", "'=' after its name"},
        {"let f : p;", "'=' follows the name"},
        {"monitor m : G p;", "'=' follows the name"},
        {"# a comment", "'//'"},
        {"target t = load(“x.npy”);", "double quotes"},
        {"target t = load('x.npy');", "double quotes"},
        {"predicate u = x <= calibrated(conformal, 0.1);", "alpha = 0.1)"},
        {"predicate u = x <= calibrated(conformal, alpha: 0.2);", "alpha = 0.1)"},
        {"predicate u = x <= calibrated(0.1);", "calibrated(conformal, alpha = 0.1)"},
        {"predicate u = x <= calibrated(alpha = 0.1);", "calibrated(conformal, alpha = 0.1)"},
        {"predicate u = x <= conformal(0.1);", "calibrated(conformal, alpha = 0.1)"},
        {"monitor m = F p calibrated(conformal, 0.1);", "alpha = 0.1, against = missed_alarm)"},
        {"target t = fitted(medoids, 8);", "k = 8"},
        {"predicate u = euclidean(z, goal) <= 1;", "did you mean 'l2'?"},
        {"predicate u = cos(z, goal) <= 1;", "did you mean 'cosine'?"},
        {"predicate u = L2(z, goal) <= 1;", "did you mean 'l2'?"},
        {"predicate u = pow(x, 2) <= 1;", "a square is a product"},
    };
    expect_cures(kCases, alone);
    EXPECT_NE(said_of("", "monitor m = G true;").find("'spec NAME;'"), std::string::npos);
    EXPECT_NE(said_of("", "spec a\ninput p : bool;\nmonitor m = G p;").find("';'"),
              std::string::npos);
}

TEST(Foreign, NumbersThatAreRight) {
    for (const char* line : {"rate 5Hz;", "predicate u = x <= 1e3; monitor m = F u;"})
        EXPECT_EQ(Checked(std::string(kHead) + line).sink.errors(), 0U) << line;
}

/// Names of the spec come first.
TEST(Foreign, DeclaredNamesAreNames) {
    const Checked checked(
        "spec a; input finally, P, N, frames, steps, then : bool;\n"
        "monitor m = G (finally && P && N -> F[0, 2 steps] (frames || steps || then));");
    EXPECT_EQ(checked.codes(), "") << checked.diagnostics();
}

}  // namespace
