#include "exhaustive.hpp"

#include <fmt/format.h>

#include <map>

namespace etlc::tests {
namespace {

using Formulas = std::vector<std::string>;

const Formulas kConnectives = {"p",         "!p",         "p && q",     "p || q",
                               "p -> q",    "p <-> q",    "!(p <-> q)", "!(p && q || !q)",
                               "p && !p",   "p || !p",    "true",       "false",
                               "p && true", "q || false", "p -> false"};

const Formulas kBounded = {"[0, 0]", "[0, 2]", "[1, 1]", "[1, 3]", "[2, 2]", "[2, 4]"};
const Formulas kUnbounded = {"", "[1, inf]", "[2, inf]"};

Formulas with(const Formulas& intervals, const std::string& before, const std::string& after) {
    Formulas result;
    for (const std::string& interval : intervals) result.push_back(before + interval + after);
    return result;
}

void append(Formulas& all, const Formulas& more) {
    all.insert(all.end(), more.begin(), more.end());
}

/// Every operator with an interval, with each of `intervals`, and negated.
void append_operators(Formulas& all, const Formulas& intervals, const Formulas& unary,
                      const Formulas& binary) {
    for (const std::string& op : unary) append(all, with(intervals, op, " p"));
    for (const std::string& op : binary) append(all, with(intervals, "p " + op, " q"));
    for (const std::string& op : binary) append(all, with({intervals.back()}, "!(p " + op, " q)"));
}

const Formulas kWithoutInterval = {"X p", "!X p", "X X q", "Y p", "!Y p", "Y Y q"};
/// With constant operands the result depends only on whether the window has a position.
const Formulas kOverConstants = {
    "F[2, 3] true",   "G[1, 2] false",   "O[2, 3] true",   "H[1, 2] false",
    "p S[2, 2] true", "p S[1, 3] true",  "true S[1, 2] q", "!(p S[2, 2] true)",
    "p U[1, 2] true", "p R[1, 2] false", "X true",         "!X true",
    "Y true",         "!Y true",         "O[1, inf] true", "p S[1, inf] true",
    "q U[2, 3] true",
};
const Formulas kWeakUntil = {"p W q", "!(p W q)", "(p && q) W !p"};

const Formulas kUnboundedNestings = {
    "F (p && F q)",
    "F (p && F (q && F p))",
    "G (p -> F q)",
    "G (p || G q)",
    "F G p",
    "G F p",
    "F (p && G q)",
    "G (p -> q U p)",
    "(F p) U q",
    "p U F q",
    "p U G q",
    "(G p) R q",
    "p R (F q)",
    "(p U q) U p",
    "p U (q U p)",
    "p W F q",
    "G (p W q)",
    "F (p R q)",
    "F p && G q",
    "F p || G q",
    "F p <-> G q",
    "!(F p && G (q -> F p))",
    "F[1, inf] (p && G[1, inf] q)",
    "X (p U q)",
    "p U X q",
    "G (p -> X q)",
    "F (p && X q)",
    "G (!p || X F q)",
    "(p W q) W p",
    "F (p <-> F q)",
};

const Formulas kBoundedNestings = {
    "F[0, 2] G[0, 1] p",  "G[0, 1] F[1, 2] p", "G (p -> F[0, 2] q)",
    "F (p && G[1, 2] q)", "(p U[0, 2] q) U p", "p U[1, 2] (q R[0, 1] p)",
    "G[1, 3] (p -> X q)", "X X X p",           "F[0, 1] (p && F[0, 1] q)",
    "G (q R[0, 2] p)",    "!X F[1, 2] p",      "F[1, 2] p && G[0, 3] q",
};

const Formulas kOverThePast = {
    "G (p -> O q)",
    "F (p && H q)",
    "F (p S q)",
    "G Y p",
    "G (O[0, 2] p)",
    "F (H[1, 2] q)",
    "G (p S[0, 2] q)",
    "G !(p S[1, 3] q)",
    "F (p && Y q)",
    "p U O q",
    "G[1, inf] (q -> H[1, inf] p)",
    "F[1, 3] O[1, inf] p",
    "X O p",
    "G (p || !O[2, 3] q)",
    "F H p",
    "G O p",
    "G (p S[2, 2] true)",
    "F O[2, 2] true",
    "G O O[1, inf] p",
    "F H H[1, inf] q",
    "G[1, inf] O[1, inf] O q",
};

const Formulas kSlidingNestings = {
    "F[0, 2] G[0, 1] p",
    "G[0, 1] F[1, 2] p",
    "p U[0, 2] (q R[1, 2] p)",
    "O F[0, 2] p",
    "H[0, 2] X q",
    "(F[0, 1] p) S q",
    "p S[0, 2] (X q)",
    "!((G[0, 1] p) S[1, 2] X q)",
    "(X p) S[2, 2] true",
    "true S[2, 2] X q",
    "Y X p",
    "X Y p",
    "O[1, 2] p && X q",
    "p -> F[0, 3] q",
    "X p <-> Y q",
    "G[1, 2] (p -> O q)",
    "F[0, 2] (p S q)",
    "H p || G[0, 2] q",
};

/// Some with a window that is longer than the trace, and all with more than one answer.
const Formulas kCounts = {
    "count(p, 2) >= 1",       "count(p, 3) >= 2",         "count(p, 5) >= 2",
    "count(p, 9) >= 3",       "count(p, 4) < 2",          "count(p, 3) == 1",
    "count(p, 5) != 1",       "!(count(q, 3) > 1)",       "count(p && !q, 5 steps) >= 2",
    "count(p S q, 3) >= 2",   "2 <= count(O[0, 1] p, 4)", "fraction(p, 1) >= 0.5",
    "fraction(p, 3) >= 0.5",  "fraction(p, 4) > 0.5",     "fraction(p, 3) >= 1",
    "fraction(p, 9) < 0.3",   "0.2 < fraction(p, 5)",     "fraction(p && !q, 5 steps) <= 0.4",
    "fraction(p S q, 3) > 0",
};
const Formulas kCountsAhead = {
    "F count(p, 3) >= 2",
    "G count(p, 3) < 2",
    "X count(p, 5) >= 2",
    "p U count(q, 3) >= 2",
    "G (count(p, 4) < 2 || F[0, 2] q)",
    "F (p && F count(q, 3) >= 2)",
    "G[1, 3] count(p <-> q, 3) < 2",
    "F fraction(p, 3) >= 0.6",
    "G fraction(p, 4) < 0.7",
    "G[2, inf] fraction(p, 3) > 0.5",
    "q U fraction(p, 2) >= 1",
    "G (fraction(p <-> q, 4) <= 0.5 || F[0, 2] q)",
};

/// How a chain continues after `{0}`, its operand, with `{1}`, its rest; the last one is its end.
struct ChainKind {
    const char* link;
    const char* end;
    const char* whole = "{1}";
};
const std::map<std::string, ChainKind> kChains = {
    {"F", {"F ({0} && {1})", "F {0}"}},
    {"then", {"F ({0} && X {1})", "F {0}"}},
    {"G", {"G ({0} || {1})", "G {0}"}},
    {"later G", {"G[1, inf] ({0} || {1})", "G {0}"}},
    {"U", {"({0} U {1})", "{0}"}},
    {"U and", {"({0} U ({0} && {1}))", "({0} U {0})"}},
    {"U and X", {"({0} U ({0} && X {1}))", "X {0}"}},
    {"R", {"({0} R {1})", "{0}"}},
    {"R or", {"({0} R ({0} || {1}))", "F {0}"}},
    {"W", {"({0} W {1})", "{0}"}},
    {"until", {"({1} U {0})", "{0}"}},
    {"release", {"({1} R {0})", "{0}"}},
    {"mixed", {"F ({0} && (!{0} || G {0} || {1}))", "F[2, 2] {0}"}},
    {"answer", {"F ({0} && {1})", "F {0}", "G ({0} -> {1})"}},
    {"later answer", {"F[1, inf] ({0} && {1})", "F {0}", "G ({0} -> {1})"}},
    {"refusal", {"G ({0} || {1})", "G {0}", "F (!{0} && {1})"}},
    {"answer by U", {"F ({0} && {1})", "F {0}", "G ({0} -> {0} U ({0} && {1}))"}},
    {"U in turn", {"({0} U ({1} U {0}))", "{0}"}},
    {"R in turn", {"({0} R ({1} R {0}))", "{0}"}},
    {"timed in turn", {"F[0, 14] ({0} && F[0, 1] ({0} && {1}))", "F[0, 3] {0}"}},
    {"timed U", {"({0} U[2, 13] ({0} && {1}))", "({0} U[1, 9] {0})"}},
    {"timed G", {"G[1, 11] ({0} || {1})", "G[0, 12] {0}"}},
    {"delayed", {"F[2, inf] ({0} && F[3, 3] {1})", "G[1, inf] {0}"}},
};

const Formulas kNumbersOfOneInput = {
    "x@1 >= 0",
    "x@2 > x",
    "x@3 - x >= 0",
    "x@1@2 == -1",
    "x@2 != 2",
    "abs(x - x@1) <= 1",
    "mean(x, 1 step) > 0",
    "mean(x, 2 steps) > 0",
    "mean(x, 3 steps) >= 1",
    "mean(x, 4 steps) - x@1 <= 0",
    "mean(x@2, 2 steps) < 1",
    "mean(abs(x - x@1), 2 steps) <= 1.5",
    "min(x, 2 steps) >= 0",
    "min(x, 4 steps) > -1",
    "max(x, 3 steps) > 0",
    "max(x, 2 steps) == 2",
    "max(x, 2 steps) - min(x, 3 steps) <= 1",
    "min(max(x, 2 steps), 2 steps)@1 >= 0",
    "max(mean(x, 2 steps), 3 steps) <= 1",
};
const Formulas kNumbersOfTwoInputs = {
    "(x - y)@1 >= 0",
    "(x - y@1)@2 < 1",
    "mean(x - y, 2 steps) > 0",
    "max(x, y)@2 >= 1",
    "max(max(x, y), 2 steps) > 1",
    "l1([x, y], [x, y]@1) <= 1",
    "linf([x@2, y], [y@1, x]) <= 1",
    "min l1([x, y@2], spots) <= 1",
    "min(min l1([x, y]@1, spots), 2 steps) <= 1",
};
const Formulas kPointsOfOneInput = {
    "l2(z, z@1) <= 1",
    "l2(z, z@3) > 1",
    "l1(z@1, z@4) <= 1",
    "cosine(z, z@2) <= 1",
    "l2(P(z), P(z@2)) <= 2",
    "l2(P(z)@2, P(z)) < 2",
    "l2(P(z@1)@1, P(z)@3) < 2",
    "linf([z, z@1], [z, z@1]@2) <= 1",
    "l2sq([z, z@1], [z@3, z]) <= 9",
    "min l1([z, z@2], corners) <= 1",
    "min l1([z, z@1]@1, corners) <= 1",
    "min l1(z@2, goal) <= 1",
    "min l2(P(z@1), own) <= 1",
    "min l2(P(z)@3, own) <= 1",
    "min l1(z, goal)@2 > 0",
    "l2(z, z@1)@2 <= 1",
    "max(l2(z, z@1), 2 steps) <= 1",
    "mean(l1(z, z@2), 2 steps) <= 1",
    "min l1(z, goal) < min l1(z, goal)@1",
    "l1(z - 2 * z@1 + z@2, nothing) <= 2",
    "l2(z, 2 * z@1 - z@2) <= 3",
    "l1((z - z@2)@1, -(z@1 - z)) < 3",
    "l1(0.5 * (z + z@3) - z@1, nothing) <= 1",
    "min l1(P(z - z@1), goal) <= 5",
    "l1(P(z) - P(z)@2, own) > 3",
    "linf([z - z@1, z@2], [z@1, z + z@1]) <= 2",
    "min l1([z@2, z - z@1]@1, corners) <= 1",
    "cosine(z - z@1, z@1 - z@2) <= 1",
    "l1(head(z), tail(z@1)) <= 3",
    "l1(head(z) - tail(z@1), middle) <= 3",
    "l1((2 * tail(z) - head(z@1))@1, middle) < 6",
};
const Formulas kPointsOfTwoInputs = {
    "l2(z, w@1) <= 1",
    "l1(z@2, w) < 2",
    "l2(w, w@1) <= 1",
    "l2(P(z), P(w@1)) <= 2",
    "linf([z, w@1], [w, z@2]) <= 1",
    "min l1([z@1, w], corners) <= 1",
    "min l1([w, z]@2, corners) <= 1",
    "mean(l1(z, w), 2 steps) <= 1",
    "l1(z - w, nothing) <= 2",
    "l1(z + w@1, 2 * w - z@1) < 3",
    "l1(P(w) - P(z), own) <= 6",
    "l1(P(w - z), nothing) <= 6",
    "l1(head(w) + tail(z@1), middle) <= 4",
    "min l1([z - w@1, w], corners) <= 1",
};

std::string spec(const std::string& name, const std::string& kind, const Formulas& formulas) {
    std::string result = fmt::format(
        "spec {};\n"
        "input x : f32 in [-4, 4];\n"
        "input y : f32 in [-8, 8];\n"
        "predicate p = x >= 0;\n"
        "predicate q = y > 0;\n",
        name);
    for (std::size_t n = 0; n < formulas.size(); ++n)
        result += fmt::format("{} m{} = {};\n", kind, n, formulas[n]);
    return result;
}

}  // namespace

std::string exhaustive_spec(const std::string& name, const std::string& kind) {
    Formulas formulas = kConnectives;
    append(formulas, kWithoutInterval);
    for (const Formulas* intervals : {&kBounded, &kUnbounded})
        append_operators(formulas, *intervals, {"F", "G", "O", "H"}, {"U", "R", "S"});
    for (const Formulas* more : {&kOverConstants, &kWeakUntil, &kUnboundedNestings,
                                 &kBoundedNestings, &kOverThePast, &kCounts, &kCountsAhead})
        append(formulas, *more);
    return spec(name, kind, formulas);
}

std::string exhaustive_sliding_spec(const std::string& name) {
    Formulas formulas = kConnectives;
    append(formulas, kWithoutInterval);
    append_operators(formulas, kBounded, {"F", "G", "O", "H"}, {"U", "R", "S"});
    append_operators(formulas, kUnbounded, {"O", "H"}, {"S"});
    append(formulas, kOverConstants);
    append(formulas, kSlidingNestings);
    append(formulas, kCounts);
    append(formulas,
           {"count(X p, 3) >= 2", "count(F[0, 2] p, 4) < 2", "fraction(G[0, 1] p, 3) > 0.5"});
    return spec(name, "sliding monitor", formulas);
}

const std::vector<std::string>& chain_kinds() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const auto& [name, parts] : kChains) result.push_back(name);
        return result;
    }();
    return names;
}

std::string chain(const std::string& kind, const std::vector<std::string>& operands) {
    const ChainKind& parts = kChains.at(kind);
    std::string result = fmt::format(fmt::runtime(parts.end), operands.back());
    for (std::size_t n = operands.size() - 1; n-- > 0;)
        result = fmt::format(fmt::runtime(parts.link), operands[n], result);
    return fmt::format(fmt::runtime(parts.whole), operands.front(), result);
}

std::string exhaustive_chains_spec(const std::string& name, const std::string& kind,
                                   std::size_t phases) {
    const Formulas kOperands = {"p", "q", "!p", "(p || Y q)", "O q", "!q", "(q && H p)", "p"};
    Formulas formulas;
    for (const std::string& chained : chain_kinds())
        for (std::size_t n = 1; n <= phases; ++n) {
            Formulas operands;
            for (std::size_t i = 0; i < n; ++i) operands.push_back(kOperands[i % kOperands.size()]);
            formulas.push_back(chain(chained, operands));
        }
    return spec(name, kind, formulas);
}

std::string exhaustive_past_spec(const std::string& name, const PastShape& shape) {
    const std::string& more = shape.of_inputs;
    std::string result = fmt::format("spec {};\n", name);
    int monitors = 0;
    if (shape.points)
        result += fmt::format(
            "input z : f16[1]{0};\n{1}"
            "projection P = [[2]] offset [1];\n"
            "projection head = [[1]] in half;\n"
            "projection tail = [[3]] offset [2] in half;\n"
            "target goal = [[2]];\n"
            "target nothing = [[0]];\n"
            "target middle = [[1]] of head(z);\n"
            "target own = [[4]] of P(z);\n"
            "target corners = [[2, 2], [-1, 2]];\n",
            more, shape.inputs > 1 ? "input w : i8[1] scale 1;\n" : "");
    else
        result += fmt::format(
            "input x : f32 in [-4, 4]{0};\n{1}"
            "target spots = [[2, 1], [-1, -2]];\n",
            more, shape.inputs > 1 ? "input y : f32 in [-8, 8];\n" : "");
    Formulas comparisons = shape.points ? kPointsOfOneInput : kNumbersOfOneInput;
    if (shape.inputs > 1) comparisons = shape.points ? kPointsOfTwoInputs : kNumbersOfTwoInputs;
    const std::string now = shape.points ? "min l1(z, goal) > 1" : "x > 0";
    result += fmt::format("predicate now = {};\n", now);
    for (std::size_t n = 0; n < comparisons.size(); ++n) {
        result += fmt::format("predicate p{0} = {1};\n", n, comparisons[n]);
        for (const char* formula : {"G p{0}", "F (now && p{0})", "now U p{0}"})
            result += fmt::format("{} m{} = {};\n", shape.kind, monitors++,
                                  fmt::format(fmt::runtime(formula), n));
        result += fmt::format("sliding monitor s{0} = p{0} -> F[0, 1] Y p{0};\n", n);
    }
    return result;
}

AllTraces::AllTraces(std::size_t steps, bool gaps, std::size_t inputs)
    : steps_(steps), values_(gaps ? 3 : 2), inputs_(inputs) {
    for (std::size_t n = 0; n < inputs * steps; ++n) size_ *= values_;
}

reference::Trace AllTraces::operator[](std::size_t number) const {
    const auto sample = [&](std::vector<double> values) {
        const std::size_t choice = number % values_;
        number /= values_;
        return choice == 2 ? std::vector<double>{} : std::vector<double>{values[choice]};
    };
    reference::Trace trace;
    for (std::size_t n = 0; n < steps_; ++n) {
        auto x = sample({-1, 2});
        trace.push_back({std::move(x)});
        if (inputs_ > 1) trace.back().push_back(sample({-2, 1}));
    }
    return trace;
}

}  // namespace etlc::tests
