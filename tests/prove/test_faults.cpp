// Tests `etlc prove` on faults that are planted in the text of a class: each is found, or the claim
// that it breaks is withheld. ETLC_EFFORT=10 plants more than 60 in each kind of class.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "proving.hpp"

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

/// Whether a fault shows in the first episodes of kSteps steps; else only "for all lengths" is
/// wrong.
enum class Shows { soon, late };
constexpr std::uint32_t kSteps = 16;

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
    add("a step late in the episode", "if (position_ == 700) d_ = " + no + ";", Shows::late);
    add("every 128 steps", "if (position_ % 128 == 127) d_ = " + no + ";", Shows::late);
    add("16 bits", "if (static_cast<uint16_t>(position_) == 900) d_ = " + no + ";", Shows::late);
    add("the bit for final of d is lost", verdicts + ".d.status = 4u;");
    faults.push_back({"the same by a function",
                      {{"  /// Advances every formula",
                        "  void poke() { d_ = " + yes + "; }\n  /// Advances every formula"},
                       {kReturn[boolean ? 1 : 0], "  if (" + verdicts + ".b.final()) poke();\n" +
                                                      kReturn[boolean ? 1 : 0]}}});
    if (boolean) return faults;
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
            const std::size_t part = code.find(change.part);
            if (part == code.npos) continue;
            std::string now = line;
            now.replace(part, std::string(change.part).size(), change.now);
            faults.push_back({code + " -> " + now, {{line, now}}});
        }
        if (is_reset && code.ends_with(";\n")) faults.push_back({"without " + code, {{line, ""}}});
    }
    return faults;
}

void expect_found(const pipeline::Compiled& spec, const std::string& text, const TextFault& fault) {
    const auto proof = prove::prove(spec.plan, {planted(text, fault), "proved", kSteps});
    if (!proof) return;
    EXPECT_TRUE(proof->fault || (fault.shows == Shows::late && !proof->repeats)) << fault.name;
}

void plant(check::Values values) {
    const bool boolean = values == check::Values::boolean;
    const auto spec = compiled(kSpec, values);
    ASSERT_TRUE(spec);
    const std::string text = header_of(spec->plan);
    const auto right = prove::prove(spec->plan, {text, "proved", kSteps});
    ASSERT_TRUE(right) << right.failure().message;
    ASSERT_FALSE(right->fault);
    EXPECT_GT(right->together, 4U);
    std::vector<TextFault> faults = faults_of_use(boolean);
    const std::vector<TextFault> lines = faults_of_lines(text, boolean);
    faults.insert(faults.end(), lines.begin(), lines.end());
    ASSERT_GE(faults.size(), 60U);
    const std::size_t every = std::max<std::size_t>(1, 10 / static_cast<std::size_t>(effort()));
    for (std::size_t n = 0; n < faults.size(); n += every) expect_found(*spec, text, faults[n]);
}

TEST(ProveFaults, OfRobustness) {
    plant(check::Values::robustness);
}
TEST(ProveFaults, OfTruths) {
    plant(check::Values::boolean);
}

}  // namespace
