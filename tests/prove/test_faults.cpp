// Tests `etlc prove` on wrong classes. Faults are planted in the text of a class: each is found, or
// the claim that it breaks is withheld; ETLC_EFFORT=10 plants more than 60 in each kind of class.
// Others are planted in a plan, an interval off by one or a fold of the wrong kind: one that
// changes a verdict on some random trace is found, and the input that shows it does.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "proving.hpp"
#include "random.hpp"
#include "random_formula.hpp"
#include "random_trace.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

/// A spec whose class has a line for everything that a fault below leaves out.
constexpr const char* kSpec =
    "spec faults;\n"
    "input x, y : f32;\n"
    "predicate near = x <= 0.5;\n"
    "predicate far = y > 1;\n"
    "monitor a = F[0, 4] (near && F far);\n"
    "repeating monitor b = G (near -> F[0, 3] far);\n"
    "sliding monitor c = G[0, 5] near;\n"
    "monitor d = F far;\n"
    "restartable monitor e = F[2, 3] near;\n";

/// Whether a fault shows in the first episodes of kFaultSteps steps; else only "for all lengths" is
/// wrong.
enum class Shows { soon, late };
constexpr std::uint32_t kFaultSteps = 16;

struct TextFault {
    std::string name;
    std::vector<std::pair<std::string, std::string>> edits;
    Shows shows = Shows::soon;
};

std::string planted(std::string text, const TextFault& fault) {
    for (const auto& [old, now] : fault.edits) {
        const std::size_t at = text.find(old);
        EXPECT_NE(at, std::string::npos) << fault.name << ": " << old;
        if (at != std::string::npos) text.replace(at, old.size(), now);
    }
    return text;
}

const std::string kReturn[] = {"  return verdicts;\n}", "  return answers_;\n}"};

/// Adds a statement at the end of a step.
TextFault at_the_end(bool boolean, const std::string& name, const std::string& statement,
                     Shows shows = Shows::soon) {
    const std::string& end = kReturn[boolean ? 1 : 0];
    return {name, {{end, "  " + statement + "\n" + end}}, shows};
}

/// Faults of how the class is used: the constructor, reset(), finish(), restarts, names, and state
/// besides its members.
std::vector<TextFault> faults_of_use(bool boolean) {
    const std::string no = boolean ? "etlmon::kNo" : "etlmon::kFalse";
    const std::string yes = boolean ? "etlmon::kYes" : "etlmon::kTrue";
    const std::string verdicts = boolean ? "answers_" : "verdicts";
    const std::string type = boolean ? "etlmon::BooleanVerdict" : "etlmon::Verdict";
    std::vector<TextFault> faults{
        {"the constructor leaves out reset()", {{"noexcept { reset(); }", "noexcept {}"}}},
        {"reset() leaves out the calls of finish()", {{"    finishes_ = 0;\n", ""}}},
        {"finish() resets the class in its 7th call",
         {{"      ++finishes_;\n", "      ++finishes_; if (finishes_ > 6) reset();\n"}}},
        {"finish() does not count", {{"      ++finishes_;\n", ""}}},
        {"b restarts when a is final", {{verdicts + ".b.final())", verdicts + ".a.final())"}}},
        {"b restarts whenever it is violated",
         {{verdicts + ".b.final())", verdicts + ".b.violated())"}}},
        {"b does not restart after an alarm",
         {{verdicts + ".b.final())", verdicts + ".b.final() && !" + verdicts + ".b.alarm())"}}},
        {"b does not restart", {{"    restart_b();\n", "    restart_e();\n"}}},
        {"alarms are counted as fulfilled", {{".alarm() ? b_alarms_", ".satisfied() ? b_alarms_"}}},
        {"named() has two names the wrong way round",
         {{"{\"a\", verdicts.a}", "{\"d\", verdicts.a}"},
          {"{\"d\", verdicts.d}", "{\"a\", verdicts.d}"}}},
        {"two verdicts have the wrong names",
         boolean ? std::vector<std::pair<std::string, std::string>>{{"answers_.a = etlmon",
                                                                     "answers_.d = etlmon"},
                                                                    {"prefix_verdict(d_reading)",
                                                                     "prefix_verdict(a_reading)"}}
                 : std::vector<std::pair<std::string, std::string>>{{"verdicts.a = a_verdict_",
                                                                     "verdicts.d = a_verdict_"},
                                                                    {"verdicts.d = d_verdict_",
                                                                     "verdicts.a = d_verdict_"}}},
        {"d is reset only after short episodes",
         {{"    d_ = " + no + ";\n", "    if (position_ < 12) d_ = " + no + ";\n"}}},
        {"the greatest number is 2",
         {{"namespace proved {", "#undef UINT32_MAX\n#define UINT32_MAX 2u\nnamespace proved {"}}},
        {"a variable of the namespace, indented",
         {{"/// All monitors of the spec", "  uint32_t hidden = 0;\n/// All monitors of the spec"},
          {kReturn[boolean ? 1 : 0],
           "  if (++hidden > 40000000u) d_ = " + no + ";\n" + kReturn[boolean ? 1 : 0]}}},
        {"a member more",
         {{"  uint32_t position_{};", "  uint32_t more_{};\n  uint32_t position_{};"}}},
    };
    const auto add = [&](const std::string& name, const std::string& statement,
                         Shows shows = Shows::soon) {
        faults.push_back(at_the_end(boolean, name, statement, shows));
    };
    add("all is reset after an alarm of a", "if (" + verdicts + ".a.alarm()) reset();");
    add("d is unmet at the fifth incomplete step", "if (incomplete_ == 5) d_ = " + no + ";");
    add("d is unmet after an alarm of b", "if (b_alarms_ == 1) d_ = " + no + ";");
    add("d is met when b is final, asked of a copy",
        "const auto one = " + verdicts + "; if (one.b.final()) d_ = " + yes + ";");
    add("the same, written as Monitor::d_",
        "if (" + verdicts + ".b.final()) Monitor::d_ = " + yes + ";");
    add("the same, with a comment",
        "if (" + verdicts + ".b.final()) { d_ /* x */ = " + yes + "; }");
    add("d is met when both a and b are final",
        "if (" + verdicts + ".a.final() && " + verdicts + ".b.final()) d_ = " + yes + ";");
    add("d is unmet when c is violated", "if (" + verdicts + ".c.violated()) d_ = " + no + ";");
    add("a static variable", "static uint32_t calls = 0; if (++calls == 5000) d_ = " + no + ";",
        Shows::late);
    add("a local", "const uint32_t at = position_; if (at == 150) d_ = " + no + ";", Shows::late);
    add("a counter that begins again", "if (position_ == 90) position_ = 0;", Shows::late);
    faults.push_back(
        {"a counter that does not stay", {{"if (position_ != UINT32_MAX) {", "{"}}, Shows::late});
    add("a step late in the episode", "if (position_ == 700) d_ = " + no + ";", Shows::late);
    add("every 128 steps", "if (position_ % 128 == 127) d_ = " + no + ";", Shows::late);
    add("16 bits", "if (static_cast<uint16_t>(position_) == 900) d_ = " + no + ";", Shows::late);
    add("the bit for final of d is lost", verdicts + ".d.status = 4u;");
    faults.push_back({"the same by a function",
                      {{"  /// Advances every formula",
                        "  void poke() { d_ = " + yes + "; }\n  /// Advances every formula"},
                       {kReturn[boolean ? 1 : 0], "  if (" + verdicts + ".b.final()) poke();\n" +
                                                      kReturn[boolean ? 1 : 0]}}});
    if (boolean) {
        add("d is unmet when x is there", "if (!etlmon::is_nan(in.x)) d_ = " + no + ";");
        return faults;
    }
    add("d is unmet when far alone is missing",
        "if (now.near.low == now.near.high && now.far.low != now.far.high) d_ = " + no + ";");
    add("d is unmet when a is far from its threshold",
        "if (verdicts.a.robustness < -1.0f) d_ = " + no + ";");
    faults.push_back(
        {"d is unmet when x is there",
         {{"  near_ = etlmon::accept(in.x);\n",
           "  near_ = etlmon::accept(in.x);\n  if (!etlmon::is_nan(near_)) d_ = " + no + ";\n"}}});
    faults.push_back({"step() judges twice",
                      {{"{ return judge(measure(in)); }",
                        "{ judge(measure(in)); return judge(measure(in)); }"}}});
    faults.push_back({"measure() exchanges two atoms",
                      {{"now.near = ", "now.far = "},
                       {"now.far = etlmon::at_least", "now.near = etlmon::at_least"}}});
    return faults;
}

/// Each line of the temporal part, left out or with a number or an operator changed.
std::vector<TextFault> faults_of_lines(const std::string& text, bool boolean) {
    struct Change {
        const char* part;
        std::string now;
    };
    const std::vector<Change> changes{{"min_of(", "max_of("},
                                      {"max_of(", "min_of("},
                                      {"kTrue", "kFalse"},
                                      {"kFalse", "kTrue"},
                                      {"kYes", "kNo"},
                                      {"kNo;", "kYes;"},
                                      {"position_ >= ", "position_ + 1 >= "},
                                      {"position_ <= ", "position_ + 1 <= "},
                                      {"position_ < ", "position_ + 1 < "},
                                      {"exists(5)", "exists(4)"},
                                      {".high", ".low"},
                                      {"Greatest<", "Least<"}};
    std::vector<TextFault> faults;
    const std::size_t reset = text.find("constexpr void reset()");
    const std::size_t step = text.rfind(boolean ? "const bool a_open" : "using etlmon::min_of;");
    for (std::size_t at = reset; at < text.size();) {
        const std::size_t end = text.find('\n', at) + 1;
        const std::string line = text.substr(at, end - at);
        const std::string code = line.substr(0, line.find("//"));
        const bool is_reset = at < text.find("/// Takes one time step");
        at = end == 0 ? text.size() : end;
        if (!is_reset && at < step) continue;
        // What a line changes is found where the line stands first.
        if (text.find(line) + line.size() != at) continue;
        const auto has = [&](const char* name) { return code.find(name) != code.npos; };
        if (has("incomplete_") || has(" near_ ") || has(" far_ ")) continue;  // telemetry
        for (const Change& change : changes) {
            const std::size_t part = code.rfind(change.part);
            if (part == code.npos) continue;
            std::string now = line;
            now.replace(part, std::string(change.part).size(), change.now);
            faults.push_back({code + " -> " + now, {{line, now}}});
        }
        if (is_reset && code.ends_with(";\n")) faults.push_back({"without " + code, {{line, ""}}});
    }
    return faults;
}

/// How a fault shows.
enum class Outcome { found, withheld, proved };

Outcome outcome_of(const Compiled& spec, const std::string& text, const TextFault& fault) {
    const auto proof = prove::prove(spec.plan, {planted(text, fault), "proved", kFaultSteps});
    if (!proof) return Outcome::withheld;
    if (proof->fault) return Outcome::found;
    return fault.shows == Shows::late && !proof->repeats ? Outcome::withheld : Outcome::proved;
}

class ProveFaults : public testing::Test {
protected:
    static void plant(check::Values values);
};

void ProveFaults::plant(check::Values values) {
    const bool boolean = values == check::Values::boolean;
    const auto spec = compiled(kSpec, values);
    ASSERT_TRUE(spec);
    const std::string text = header_of(spec->plan);
    const auto right = prove::prove(spec->plan, {text, "proved", kFaultSteps});
    ASSERT_TRUE(right) << right.failure().message;
    ASSERT_FALSE(right->fault);
    EXPECT_GT(right->together, 4U);
    std::vector<TextFault> faults = faults_of_use(boolean);
    const std::vector<TextFault> lines = faults_of_lines(text, boolean);
    faults.insert(faults.end(), lines.begin(), lines.end());
    ASSERT_GE(faults.size(), 60U);
    const std::size_t every = effort() < 10 ? 1 + faults.size() / 3 : 1;
    int found = 0;
    std::string withheld;
    for (std::size_t n = 0; n < faults.size(); n += every) {
        const Outcome outcome = outcome_of(*spec, text, faults[n]);
        EXPECT_NE(outcome, Outcome::proved) << faults[n].name;
        found += outcome == Outcome::found ? 1 : 0;
        if (outcome == Outcome::withheld) withheld += faults[n].name + "; ";
    }
    RecordProperty("found", found);
    RecordProperty("withheld", withheld);
}

TEST_F(ProveFaults, OfRobustness) {
    plant(check::Values::robustness);
}
TEST_F(ProveFaults, OfTruths) {
    plant(check::Values::boolean);
}

// ---- faults of a plan

using Fault = std::function<void(plan::Plan&)>;

void change_interval(ir::Interval& interval, bool low, bool up) {
    std::uint32_t& end = low || !interval.bounded() ? interval.low : interval.high;
    if (up || end == 0)
        ++end;
    else
        --end;
}

/// Returns the faults that can be made of a plan without changing the size of the class.
std::vector<Fault> faults_of(const plan::Plan& plan) {
    using Op = plan::StreamOp;
    std::vector<Fault> faults;
    for (std::size_t s = 0; s < plan.streams.size(); ++s) {
        const Op op = plan.streams[s].op;
        if (op == Op::combination || op == Op::running || op == Op::window || op == Op::since)
            faults.emplace_back([s](plan::Plan& of) { of.streams[s].max = !of.streams[s].max; });
        for (const bool low : {true, false})
            if (op == Op::within)
                faults.emplace_back([s, low](plan::Plan& of) {
                    change_interval(of.streams[s].interval, low, true);
                });
    }
    for (std::size_t r = 0; r < plan.readings.size(); ++r) {
        const plan::Reading& reading = plan.readings[r];
        if (reading.kind == plan::Reading::Kind::combination)
            faults.emplace_back([r](plan::Plan& of) { of.readings[r].max = !of.readings[r].max; });
        for (std::size_t a = 0; a < reading.straight.assignments.size(); ++a)
            for (const bool low : {true, false})
                for (const bool up : {true, false}) {
                    // A local is assigned at every position.
                    if (reading.straight.assignments[a].target != plan::Term::Kind::reg) continue;
                    faults.emplace_back([=](plan::Plan& of) {
                        change_interval(of.readings[r].straight.assignments[a].positions, low, up);
                    });
                }
        for (std::size_t t = 0; t + 1 < reading.table.transitions.size(); ++t)
            faults.emplace_back([r, t](plan::Plan& of) {
                auto& transitions = of.readings[r].table.transitions;
                std::swap(transitions[t].guard, transitions[t + 1].guard);
            });
        for (std::size_t p = 0; p < reading.pending.parts.size(); ++p)
            faults.emplace_back([r, p](plan::Plan& of) {
                of.readings[r].pending.parts[p].max = !of.readings[r].pending.parts[p].max;
            });
    }
    return faults;
}

using Verdicts = std::vector<etlmon::Verdict>;

/// Whether verdicts differ. Bounds may be tighter than the definition's, unless they count.
bool differ(const Verdicts& a, const Verdicts& b, bool with_bounds) {
    for (std::size_t m = 0; m < a.size(); ++m) {
        const auto status = [&](const etlmon::Verdict& of) {
            return with_bounds ? of.status : of.status & ~std::uint32_t{etlmon::Verdict::kFinal};
        };
        if (status(a[m]) != status(b[m])) return true;
        if (!a[m].decided()) continue;
        if (a[m].robustness != b[m].robustness) return true;
        if (with_bounds && (a[m].lower != b[m].lower || a[m].upper != b[m].upper)) return true;
    }
    return false;
}

/// Whether two plans give other verdicts on some random trace.
bool differ(const plan::Plan& one, const plan::Plan& other, int traces, std::uint32_t steps) {
    execute::Evaluator first(one), second(other);
    for (int n = 0; n < traces; ++n) {
        const auto trace = random_trace(*one.model, n, {.steps = steps, .missing = 0.1});
        first.reset();
        second.reset();
        for (const reference::Step& step : trace)
            if (differ(first.step(samples(step)), second.step(samples(step)), false)) return true;
    }
    return false;
}

/// Whether the input of a proof shows the fault: the inputs of predicates are numbers.
bool is_shown(const plan::Plan& right, const plan::Plan& wrong, const prove::Proof& proof) {
    const prove::Fault& fault = *proof.fault;
    execute::Evaluator first(right), second(wrong);
    bool shown = false;
    for (std::uint32_t step = 0; step <= fault.step; ++step) {
        std::vector<execute::Sample> inputs(right.model->inputs.size());
        for (std::size_t a = 0; a < proof.atoms.size(); ++a) {
            const prove::Atom& atom = proof.atoms[a];
            const auto& known = fault.witness.values[step][a];
            if (!known) continue;
            const auto* predicate =
                atom.is_predicate ? &right.model->predicates[atom.index] : nullptr;
            execute::Sample& sample = inputs[predicate ? predicate->inputs[0] : atom.index];
            sample.present = true;
            sample.values = {predicate ? prove::measured(*predicate, *known)
                                       : (*known > 0 ? 1.0F : 0.0F)};
        }
        shown = differ(first.step(inputs), second.step(inputs), true);
    }
    for (std::uint32_t call = 0; call < fault.finishes; ++call)
        shown = differ(first.finish(), second.finish(), true);
    return shown;
}

/// A spec whose predicates compare one number each.
std::string plain_spec(std::uint64_t seed) {
    Random random(seed);
    std::string text =
        "spec plain;\n"
        "input x0, x1 : f32 in [-2, 2];\n"
        "input x2 : f32;\n"
        "input on : bool;\n"
        "predicate p0 = x0 > 0.5;\n"
        "predicate p1 = x1 <= 0.25;\n"
        "predicate p2 = x2 >= 1 missing false;\n";
    const std::vector<std::string> atoms = {"p0", "p1", "p2", "on"};
    for (int m = 0; m < 3; ++m) {
        const bool sliding = random.chance(0.4);
        RandomFormula formulas(
            random, atoms, [&] { return random.word(atoms); },
            {.depth = 3, .window = 4, .unbounded = !sliding}, fmt::format("part{}_", m));
        const std::string formula = formulas.make();
        text += formulas.take_lets() +
                fmt::format("{}monitor m{} = {};\n", sliding ? "sliding " : "", m, formula);
    }
    return text;
}

/// Proves classes of plans with a fault each; returns how many were found.
int faults_found(check::Values values, int count, std::uint32_t steps) {
    Random random(3);
    int found = 0;
    for (int n = 0; n < count; ++n) {
        const std::string text = plain_spec(n);
        const auto spec = compiled(text, values);
        if (!spec) continue;
        const std::vector<Fault> faults = faults_of(spec->plan);
        if (faults.empty()) continue;
        plan::Plan wrong = spec->plan;
        faults[random.between(0, static_cast<int>(faults.size()) - 1)](wrong);
        const auto proof = proof_of(wrong, steps);
        EXPECT_TRUE(proof) << proof.failure().message << "\n" << text;
        if (!proof) continue;
        if (proof->fault) {
            ++found;
            EXPECT_TRUE(is_shown(spec->plan, wrong, *proof))
                << proof->fault->number << " after step " << proof->fault->step << "\n"
                << text;
        } else {
            EXPECT_FALSE(differ(spec->plan, wrong, 200, steps)) << n << "\n" << text;
        }
    }
    return found;
}

TEST(Prove, FaultsOfThePlanAreFound) {
    EXPECT_GE(faults_found(check::Values::robustness, 3 * effort(), 16), 1);
}
TEST(ProveBoolean, FaultsOfThePlanAreFound) {
    EXPECT_GE(faults_found(check::Values::boolean, effort(), 8), 1);
}

}  // namespace
