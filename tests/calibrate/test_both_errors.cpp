// Simulates calibrations against one error or both, by each method: each error of the predicates
// and of monitors over them stays within its bound, on average over calibrations and new episodes.
// Also tests the labels that are unknown near a change, and what calibration refuses. The
// simulation is a sample; with ETLC_EFFORT in the environment it draws 2000 sets of demonstrations
// for each case.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "calibrate/fit.hpp"
#include "calibrate/shift.hpp"
#include "check/check.hpp"
#include "check/guarantees/guarantees.hpp"
#include "episodes/truth.hpp"
#include "execute/evaluator.hpp"
#include "ir/lower.hpp"
#include "parse/parse.hpp"
#include "plan/plan.hpp"
#include "random.hpp"
#include "roads.hpp"

namespace etlc::tests {
namespace {

using calibrate::Aim;
using calibrate::Evidence;
using calibrate::Index;
using calibrate::Sides;
using check::Guarantee;
using episodes::Label;
using Labels = std::vector<Label>;

/// Returns what a verdict predicts. episodes::label_of() does not link where its flags are others.
Label called(const etlmon::Verdict& verdict) {
    return verdict.satisfied() ? Label::yes : verdict.violated() ? Label::no : Label::unknown;
}

constexpr int kSimulatedSteps = 12;
constexpr int kNewEpisodes = 50;
/// The mean may exceed its bound by this many standard errors over the sets.
constexpr double kStandardErrors = 4;

int number_of_sets() {
    return std::getenv("ETLC_EFFORT") != nullptr ? 2000 : 40;
}

struct Case {
    std::string name;
    int demonstrations = 30;
    double missing = 0;    ///< P(a sample is missing)
    std::string clause{};  ///< " missing false"
    bool has_ties = false;
    bool in_groups = false;
    std::uint32_t within = 0;
};

struct DrawnEpisode {
    std::vector<std::vector<execute::Sample>> samples;  ///< x, y, s, u
    Labels a, b;
};

/// The offset of a group is common to its episodes.
DrawnEpisode draw(const Case& of, double offset, bool upper, Random& random) {
    DrawnEpisode drawn;
    bool a = random.chance(0.5);
    bool b = random.chance(0.3);
    const double noise = 0.5 + 0.7 * random.uniform();  // frames of an episode are alike
    const auto sample = [&](bool label) {
        double value = offset + (label ? 0 : 1) + noise * (random.uniform() + random.uniform() - 1);
        if (of.has_ties) value = std::round(4 * value) / 4;
        const bool is_there = !random.chance(of.missing);
        return execute::Sample{is_there, {static_cast<float>(upper ? value : -value)}};
    };
    for (int t = 0; t < kSimulatedSteps; ++t) {
        a = a != random.chance(0.2);
        b = b != random.chance(0.2);
        drawn.a.push_back(a ? Label::yes : Label::no);
        drawn.b.push_back(b ? Label::yes : Label::no);
        const float s = random.chance(0.3) ? 1.0F : 0.0F;
        drawn.samples.push_back({sample(a), sample(b), {true, {s}}, {}});
    }
    episodes::open_near_changes(drawn.a, of.within);
    episodes::open_near_changes(drawn.b, of.within);
    return drawn;
}

double offset_of_group(const Case& of, Random& random) {
    return of.in_groups ? 0.4 * (random.uniform() - 0.5) : 0;
}

struct Stepped {
    ir::Program program;
    plan::Plan plan;
    execute::Evaluator evaluator;

    explicit Stepped(const check::Model& model)
        : program(ir::lower(model)), plan(planned(program)), evaluator(plan) {}

private:
    static plan::Plan planned(ir::Program& program) {
        diag::Sink sink;
        return *plan::plan(program, {}, sink);
    }
};

/// A mean over episodes that differ by set, and what it may be.
class Figure {
public:
    void add(double value) {
        sum_ += value;
        ++episodes_;
    }
    void end_set() {
        sets_.emplace_back(sum_, episodes_);
        sum_ = episodes_ = 0;
    }
    bool holds(double bound) const {
        double sum = 0;
        double all = 0;
        for (const auto& [part, episodes] : sets_) {
            sum += part;
            all += episodes;
        }
        if (all == 0) return true;
        double square = 0;
        for (const auto& [part, episodes] : sets_)
            square += (part - sum / all * episodes) * (part - sum / all * episodes);
        mean_ = sum / all;
        return mean_ <= bound + kStandardErrors * std::sqrt(square) / all;
    }
    double mean() const { return mean_; }

private:
    double sum_ = 0;
    double episodes_ = 0;
    std::vector<std::pair<double, double>> sets_;
    mutable double mean_ = 0;
};

/// The errors of an episode: of positive and of negative frames or steps.
struct Errors {
    double frames[2]{};
    double wrong[2]{};

    void add(Label predicted, Label actual) {
        if (actual == Label::unknown) return;
        const std::size_t side = actual == Label::yes ? 0 : 1;
        ++frames[side];
        wrong[side] += predicted == (actual == Label::yes ? Label::no : Label::yes) ? 1 : 0;
    }
    bool any(std::size_t side) const { return wrong[side] > 0; }
};

/// Returns what a predicate says of a sample, by the definition.
Label predicted_by(const check::Predicate& p, const execute::Sample& sample) {
    if (!sample.present) return !p.missing ? Label::unknown : *p.missing ? Label::yes : Label::no;
    const float delta = sample.values[0];
    if (check::holds(p.comparison, delta, p.threshold.low())) return Label::yes;
    return check::holds(p.comparison, delta, p.threshold.value) ? Label::unknown : Label::no;
}

/// Adds a frame as its definition says: `value` is measured, or `lost` says what missing counts as.
void add(calibrate::Scores& scores, const check::Predicate& p, Label label,
         const std::optional<double>& low, const std::optional<double>& high) {
    if (label == Label::unknown) return;
    const bool positive = label == Label::yes;
    calibrate::SideScores& side = scores.side(positive);
    ++side.frames;
    if (!low) {
        side.lost += p.missing && *p.missing != positive ? 1 : 0;
        return;
    }
    if (calibrate::is_against(p.threshold, positive))
        side.add(p.upper_bound() == positive ? *high : -*low, calibrate::keeps_all(p.threshold));
}

/// Returns the thresholds; nothing where calibration refuses them.
std::optional<Sides> fitted_to(const check::Predicate& p, const Evidence& evidence) {
    Sides sides;
    for (const Aim& aim : calibrate::aims_of(p)) {
        const auto fit = calibrate::fit(p, aim, evidence);
        if (const auto* found = std::get_if<calibrate::Fitted>(&fit)) sides.push_back(*found);
    }
    const bool is_infinite = std::all_of(sides.begin(), sides.end(),
                                         [](const auto& side) { return std::isinf(side.epsilon); });
    if (sides.size() < calibrate::aims_of(p).size() || is_infinite) return std::nullopt;
    return sides;
}

/// Calibrates, and counts the errors in new episodes.
class Simulation {
public:
    Simulation(const Case& of, check::Model model, bool as_a_whole)
        : of_(of), model_(std::move(model)), as_a_whole_(as_a_whole) {
        plain_ = calibrate::unshifted(model_);
        truth_ = episodes::ground_truth(plain_, {0, 1});
        for (Index m = 0; m < model_.monitors.size(); ++m)
            guarantees_.push_back(check::guarantees(model_, model_.monitors[m]));
    }

    void run(Random& random) {
        Stepped monitors(model_);
        Stepped plain(plain_);
        Stepped truths(truth_.model);
        for (int set = 0; set < number_of_sets(); ++set) {
            if (!calibrate(plain, truths, random)) continue;
            for (plan::Monitor& monitor : monitors.plan.monitors) {
                if (!monitor.shifted) continue;
                monitor.shift = model_.monitors[monitor.index].calibration->value;
                monitor.inner_shift = model_.monitors[monitor.index].calibration->inner;
            }
            for (const Index p : {0U, 1U})
                monitors.evaluator.state().thresholds[p] = model_.predicates[p].threshold.value;
            ++used_;
            for (int i = 0; i < kNewEpisodes; ++i)
                judge(draw(of_, offset_of_group(of_, random), upper(), random), monitors, truths);
            for (auto& [name, figure] : figures_) figure.first.end_set();
        }
        // Where missing samples count as true, no shift may be enough.
        const int least = as_a_whole_ && !of_.clause.empty() ? 0 : number_of_sets() / 2;
        EXPECT_GE(used_, least) << of_.name;
        for (const auto& [name, figure] : figures_)
            EXPECT_TRUE(figure.first.holds(figure.second))
                << of_.name << ", " << name << ": " << figure.first.mean() << " of at most "
                << figure.second << ", " << model_.predicates[0].text << " "
                << model_.predicates[0].threshold.text << of_.clause;
    }
    std::size_t figures() const { return figures_.size(); }

private:
    bool upper() const { return model_.predicates[0].upper_bound(); }

    /// Calls `each(m, predicted, actual)` with the verdicts of every step that the monitors report.
    template <class Each>
    void follow(const DrawnEpisode& drawn, Stepped& monitors, Stepped& truths, const Each& each) {
        monitors.evaluator.reset();
        truths.evaluator.reset();
        for (std::size_t t = 0; t < kSimulatedSteps; ++t) {
            std::vector<execute::Sample> samples = drawn.samples[t];
            const std::vector<etlmon::Verdict> predicted = monitors.evaluator.step(samples);
            for (const Label label : {drawn.a[t], drawn.b[t]})
                samples.push_back(episodes::sample_of(label));
            const std::vector<etlmon::Verdict> actual = truths.evaluator.step(samples);
            for (std::size_t m = 0; m < predicted.size(); ++m) {
                if (predicted[m].decided() && actual[m].decided()) each(m, predicted, actual);
                if (model_.monitors[m].restarts == check::Restarts::when_final &&
                    predicted[m].final())
                    truths.evaluator.restart(m);
            }
        }
    }

    bool calibrate(Stepped& plain, Stepped& truths, Random& random) {
        std::vector<Evidence> evidence(as_a_whole_ ? model_.monitors.size() : 2);
        std::uint32_t group = 0;
        for (int i = 0; i < of_.demonstrations; ++group) {
            const double offset = offset_of_group(of_, random);
            for (int k = of_.in_groups ? random.between(1, 3) : 1; k-- > 0; ++i)
                add_demonstration(draw(of_, offset, upper(), random), group, evidence, plain,
                                  truths);
        }
        for (std::size_t i = 0; i < evidence.size(); ++i) {
            if (as_a_whole_ && i % 2 == 1) continue;  // a negation
            const check::Predicate p =
                as_a_whole_ ? calibrate::over_robustness(model_.monitors[i]) : model_.predicates[i];
            const auto sides = fitted_to(p, evidence[i]);
            if (!sides) return false;
            calibrate::set(
                as_a_whole_ ? *model_.monitors[i].calibration : model_.predicates[i].threshold, p,
                *sides);
        }
        return true;
    }

    void add_demonstration(const DrawnEpisode& drawn, std::uint32_t group,
                           std::vector<Evidence>& evidence, Stepped& plain, Stepped& truths) {
        std::vector<calibrate::Scores> scores(evidence.size());
        if (!as_a_whole_)
            for (std::size_t t = 0; t < kSimulatedSteps; ++t)
                for (const std::size_t p : {0U, 1U}) {
                    const execute::Sample& sample = drawn.samples[t][p];
                    const auto delta =
                        sample.present ? std::optional<double>(sample.values[0]) : std::nullopt;
                    add(scores[p], model_.predicates[p], (p == 0 ? drawn.a : drawn.b)[t], delta,
                        delta);
                }
        else
            follow(drawn, plain, truths,
                   [&](std::size_t m, const auto& predicted, const auto& actual) {
                       if (m % 2 == 1) return;
                       // A verdict that a missing sample leaves open at this end cannot be wrong.
                       const auto known = [](double end, double open) {
                           return end == open ? std::nullopt : std::optional(end);
                       };
                       constexpr double kInfinity = std::numeric_limits<double>::infinity();
                       // The next monitor is the negation of this one.
                       const auto low = known(predicted[m].robustness, -kInfinity);
                       const auto high =
                           known(-static_cast<double>(predicted[m + 1].robustness), kInfinity);
                       const Label label = called(actual[m]);
                       const auto& end = label == Label::yes ? high : low;
                       add(scores[m], calibrate::over_robustness(model_.monitors[m]), label, end,
                           end);
                   });
        for (std::size_t i = 0; i < scores.size(); ++i) evidence[i].add(scores[i], group);
    }

    void note(const std::string& name, double bound, double value) {
        auto& figure = figures_[name];
        figure.second = bound;
        figure.first.add(value);
    }

    /// Notes the errors of a predicate by its own promise.
    void note(const check::Predicate& p, const Errors& errors) {
        for (const Aim& aim : calibrate::aims_of(p)) {
            const std::size_t side = aim.of_positives ? 0 : 1;
            const bool by_risk = p.threshold.origin == check::ThresholdOrigin::risk;
            const bool is_void = p.missing && *p.missing != aim.of_positives && of_.missing > 0;
            if (errors.frames[side] == 0 || (is_void && !by_risk)) continue;
            note(fmt::format("{} at {} frames", p.name, side == 0 ? "positive" : "negative"),
                 std::stod(aim.rate),
                 by_risk            ? errors.wrong[side] / errors.frames[side]
                 : errors.any(side) ? 1
                                    : 0);
        }
    }

    void note(Index m, const Errors& errors) {
        using Kind = Guarantee::Kind;
        for (const Guarantee& guarantee : guarantees_[m]) {
            if (!guarantee.part.empty() || guarantee.kind == Kind::nothing ||
                guarantee.kind == Kind::exact)
                continue;
            const bool by_share =
                guarantee.kind == Kind::satisfied_share || guarantee.kind == Kind::violated_share;
            const bool of_alarms = guarantee.kind == Kind::missed_alarm ||
                                   guarantee.kind == Kind::satisfied_wrongly ||
                                   guarantee.kind == Kind::satisfied_share;
            // A bound on successes alone excludes steps with missing samples.
            if (guarantee.kind == Kind::missed_success && !as_a_whole_ && of_.missing > 0) continue;
            const std::size_t side = of_alarms ? 1 : 0;
            const std::string name = model_.monitors[m].name + ": " + check::text(guarantee);
            if (by_share && errors.frames[side] == 0) continue;
            note(name, std::stod(guarantee.bound),
                 by_share                        ? errors.wrong[side] / errors.frames[side]
                 : guarantee.kind == Kind::wrong ? (errors.any(0) || errors.any(1) ? 1 : 0)
                                                 : (errors.any(side) ? 1 : 0));
        }
    }

    void judge(const DrawnEpisode& drawn, Stepped& monitors, Stepped& truths) {
        for (const std::size_t p : {0U, 1U}) {
            if (as_a_whole_) break;
            Errors errors;
            for (std::size_t t = 0; t < kSimulatedSteps; ++t)
                errors.add(predicted_by(model_.predicates[p], drawn.samples[t][p]),
                           (p == 0 ? drawn.a : drawn.b)[t]);
            note(model_.predicates[p], errors);
        }
        std::vector<Errors> errors(model_.monitors.size());
        follow(drawn, monitors, truths,
               [&](std::size_t m, const auto& predicted, const auto& actual) {
                   errors[m].add(called(predicted[m]), called(actual[m]));
               });
        for (Index m = 0; m < errors.size(); m += as_a_whole_ ? 2 : 1) note(m, errors[m]);
    }

    Case of_;
    check::Model model_;
    bool as_a_whole_;
    check::Model plain_;
    episodes::GroundTruth truth_;
    std::vector<std::vector<Guarantee>> guarantees_;
    std::map<std::string, std::pair<Figure, double>> figures_;
    int used_ = 0;
};

check::Model uncalibrated(const std::string& text) {
    diag::Sink sink;
    const source::File file("t.etl", text);
    check::Options options;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    auto model = check::check(parse::parse(file, sink), file, options, sink);
    EXPECT_TRUE(model) << text;
    return *model;
}

std::vector<Case> cases() {
    return {{.name = "plain"},
            {.name = "missing", .missing = 0.1},
            {.name = "missing true", .missing = 0.1, .clause = " missing true"},
            {.name = "missing false", .missing = 0.05, .clause = " missing false"},
            {.name = "ties", .has_ties = true},
            {.name = "groups", .demonstrations = 60, .in_groups = true},
            {.name = "within", .demonstrations = 90, .within = 1},
            {.name = "few", .demonstrations = 8}};
}

/// Returns the comparisons for a case: all with ETLC_EFFORT, otherwise one.
std::vector<std::string> comparisons_for(std::size_t i) {
    const std::vector<std::string> all{"<=", "<", ">=", ">"};
    return std::getenv("ETLC_EFFORT") != nullptr ? all : std::vector{all[i % all.size()]};
}

std::string within_text(const Case& of) {
    return of.within > 0 ? fmt::format(", within = {} steps", of.within) : "";
}

TEST(BothErrors, OfPredicatesAndTheirMonitorsAreBounded) {
    Random random(555);
    std::size_t i = 0;
    std::size_t figures = 0;
    for (const std::string method : {"conformal", "risk"})
        for (const std::string against : {"misses", "false_positives", "both"})
            for (const Case& of : cases())
                for (const std::string& comparison : comparisons_for(i++)) {
                    const auto threshold = [&](const char* alpha, const char* beta) {
                        return fmt::format("{} calibrated({}, alpha = {}, against = {}{}{}){}",
                                           comparison, method, alpha, against,
                                           against == "both" ? beta : "", within_text(of),
                                           of.clause);
                    };
                    Simulation simulation(
                        of,
                        uncalibrated(
                            fmt::format("spec t; input x, y, s, u : f32;\n"
                                        "predicate a = x {}; predicate b = y {};\n"
                                        "monitor plain = F[0, 3] (a && F[0, 2] b);\n"
                                        "monitor negated = G (s > 0.5 -> !a);\n"
                                        "monitor alike = G[0, 4] (a <-> b);\n"
                                        "monitor counted = F[0, 6] (count(a, 3 steps) >= 2);\n"
                                        "monitor late = G[0, 3] (a -> F[0, 2] O[0, 1] b);\n"
                                        "monitor reaches = a U b;\n"
                                        "repeating monitor again = F[0, 2] a;\n"
                                        "sliding monitor window = F[0, 2] (a && !b);",
                                        threshold("0.2", ", beta = 0.25"), threshold("0.15", ""))),
                        false);
                    simulation.run(random);
                    figures += simulation.figures();
                }
    EXPECT_GT(figures, 200U);
}

TEST(BothErrors, OfWholeMonitorsAreBounded) {
    Random random(556);
    std::size_t i = 0;
    std::size_t figures = 0;
    for (const std::string method : {"conformal", "risk"})
        for (const std::string against : {"missed_alarm", "missed_success", "both"})
            for (const Case& of : cases()) {
                if (of.name == "few") continue;  // a literal threshold knows no infinite side
                for (const std::string& comparison : comparisons_for(i++)) {
                    const bool upper = comparison[0] == '<';
                    const std::string whole =
                        fmt::format(" calibrated({}, alpha = 0.2, against = {}{})", method, against,
                                    within_text(of));
                    std::string spec = fmt::format(
                        "spec t; input x, y, s, u : f32;\n"
                        "predicate a = x {0} {1}{2}; truth a = u > 0;\n"
                        "predicate b = y {0} {1}{2}; truth b = u > 0;\n",
                        comparison, upper ? "0.5" : "-0.5", of.clause);
                    int m = 0;
                    for (const std::string formula :
                         {"F[0, 3] (a && F[0, 2] b)", "G[0, 3] (s > 0.5 -> !a)",
                          "G[0, 2] (a <-> b)", "F[0, 5] (count(a, 4 steps) >= 1)",
                          "F[0, 3] (a && O[0, 1] b)"}) {
                        // Near a change no label is known, so nothing is known to rise.
                        if (of.within > 0 && formula.find("count") != std::string::npos) continue;
                        const char* const kind =
                            formula.find("O[") != std::string::npos ? "sliding " : "";
                        spec +=
                            fmt::format("{0}monitor m{1} = {2}{3};\n{0}monitor n{1} = !({2});\n",
                                        kind, m, formula, whole);
                        ++m;
                    }
                    Simulation simulation(of, uncalibrated(spec), true);
                    simulation.run(random);
                    figures += simulation.figures();
                }
            }
    EXPECT_GT(figures, 200U);
}

// ---- labels near a change -----------------------------------------------------------------------

std::string opened(const std::string& labels, std::uint32_t within) {
    Labels all;
    for (const char one : labels)
        all.push_back(one == 'y' ? Label::yes : one == 'n' ? Label::no : Label::unknown);
    episodes::open_near_changes(all, within);
    std::string text;
    for (const Label one : all) text += one == Label::yes ? 'y' : one == Label::no ? 'n' : '?';
    return text;
}

TEST(BothErrors, LabelsNearAChangeAreUnknown) {
    EXPECT_EQ(opened("nnnnyyyy", 1), "nnn??yyy");
    EXPECT_EQ(opened("nnnnyyyy", 3), "n??????y");
    EXPECT_EQ(opened("nnnnyyyy", 9), "????????");
    EXPECT_EQ(opened("nnnnyyyy", 0), "nnnnyyyy");
    EXPECT_EQ(opened("yyyy", 3), "yyyy");          // the ends are no changes
    EXPECT_EQ(opened("nnn??yyy", 1), "nn????yy");  // a gap between labels that differ
    EXPECT_EQ(opened("nnn??nnn", 1), "nnn??nnn");  // and between equal ones
    EXPECT_EQ(opened("??nn?yn", 1), "??n????");
    EXPECT_EQ(opened("", 2), "");
}

// ---- the whole command
// ---------------------------------------------------------------------------

/// Episodes of nine steps: the predicate is true from step 3 to 5, where x is at most `near`; it is
/// at least `far` elsewhere.
Files recordings(int n, double near, double far) {
    Files files;
    for (int i = 0; i < n; ++i) {
        std::string text = "x,truth.p\n";
        for (int t = 0; t < 9; ++t) {
            const bool actual = t >= 3 && t <= 5;
            const double x = actual ? near - 0.01 * i : far + 0.01 * ((i * 7 + t) % 20);
            text += fmt::format("{:.4f},{}\n", x, actual ? 1 : 0);
        }
        files.add(text);
    }
    return files;
}

constexpr const char* kOver =
    "spec t; input x : f32; predicate p = x <= calibrated({}){}; monitor m = F p;";

TEST(BothErrors, ThresholdsAreReadBackAsTheyWereWritten) {
    for (const std::string comparison : {"<=", ">"})
        for (const std::string arguments :
             {"conformal, alpha = 0.1, against = both",
              "conformal, alpha = 0.1, beta = 0.04, against = both",
              "conformal, alpha = 0.04, beta = 0.1, against = both",
              "conformal, alpha = 0.1, against = false_positives",
              "risk, alpha = 0.2, against = both", "risk, alpha = 0.2",
              "risk, alpha = 0.1, against = false_positives, within = 1 steps",
              "conformal, alpha = 0.1, against = both, within = 1 steps"})
            for (const double far : {0.5, 2.0}) {  // overlapping, and separated
                const Files files = recordings(19, 1, far);
                const std::string spec = fmt::format(
                    "spec t; input x : f32; predicate p = x {} calibrated({}); monitor m = F p;",
                    comparison, arguments);
                const Calibrated made = calibrated(spec, files.paths());
                ASSERT_FALSE(made.thresholds.empty()) << spec;
                const Checked now = checked(spec, made.thresholds);
                EXPECT_TRUE(now.model) << spec << now.text << made.thresholds;
            }
}

TEST(BothErrors, AMonitorIsReadBackAsItWasWritten) {
    for (const std::string method : {"conformal", "risk"})
        for (const std::string against : {"both", "missed_alarm", "missed_success"})
            for (const std::string within : {"", ", within = 1 steps"}) {
                const Files files = recordings(19, 1, 0.5);
                const std::string spec = fmt::format(
                    "spec t; input x : f32; predicate p = x <= 0.8;\n"
                    "sliding monitor m = F[0, 1] p calibrated({}, alpha = 0.2, against = {}{});",
                    method, against, within);
                const Calibrated made = calibrated(spec, files.paths());
                ASSERT_FALSE(made.thresholds.empty()) << spec;
                const Checked now = checked(spec, made.thresholds);
                EXPECT_TRUE(now.model) << spec << now.text << made.thresholds;
                EXPECT_EQ(made.report.find("near a change") != std::string::npos, !within.empty())
                    << made.report;
            }
}

TEST(BothErrors, AnInfiniteSideIsNamed) {
    const Files files = recordings(9, 1, 0.5);
    const Calibrated made =
        calibrated(fmt::format(kOver, "conformal, alpha = 0.1, beta = 0.05, against = both", ""),
                   files.paths());
    EXPECT_NE(made.report.find("never called true: beta = 0.05 needs at least 19 demonstrations in "
                               "which 'p' is false at some frame; there are 9"),
              std::string::npos)
        << made.report;
}

TEST(BothErrors, HalfwayAtMostTheSharesOfEitherSideAreLost) {
    const std::string spec = fmt::format(kOver, "risk, alpha = 0.2, against = both", "");
    const auto says_at_most = [&](double far) {
        const std::string report = calibrated(spec, recordings(19, 1, far).paths()).report;
        EXPECT_NE(report.find("    called true at "), std::string::npos) << report;
        return report.find("    called true at no more than ") != std::string::npos;
    };
    EXPECT_FALSE(says_at_most(0.5));
    EXPECT_TRUE(says_at_most(2));
}

/// Returns the codes and messages of a calibration that is refused.
std::string refused(const std::string& arguments, const Files& files,
                    const std::string& clause = "") {
    const Calibrated made = calibrated(fmt::format(kOver, arguments, clause), files.paths());
    EXPECT_TRUE(made.thresholds.empty()) << arguments;
    return fmt::format("{}", fmt::join(made.codes, " "));
}

TEST(BothErrors, BadInputIsRefused) {
    const Files files = recordings(9, 1, 0.5);
    EXPECT_EQ(refused("conformal, alpha = 0.05, against = both", files), "E0662");  // both infinite
    EXPECT_EQ(refused("risk, alpha = 0.05, against = both", files), "E0662");
    EXPECT_EQ(refused("conformal, alpha = 0.05, against = false_positives", files), "E0662");
    EXPECT_EQ(refused("risk, alpha = 0.05", files), "E0662");
    // labels are unknown at all steps
    EXPECT_EQ(refused("conformal, alpha = 0.1, within = 20 steps", files), "E0661");
    EXPECT_EQ(refused("conformal, alpha = 0.1, against = both, within = 20 steps", files), "E0662");
    Files true_everywhere;
    for (int i = 0; i < 9; ++i)
        true_everywhere.add(fmt::format("x,truth.p\n{0},1\n{0},1\n0.{0},1\n", i + 1));
    EXPECT_EQ(refused("conformal, alpha = 0.1, against = false_positives", true_everywhere),
              "E0661");
    const Calibrated made = calibrated(
        fmt::format(kOver, "conformal, alpha = 0.1, against = both", ""), true_everywhere.paths());
    EXPECT_NE(made.report.find("never called true"), std::string::npos) << made.report;
    Files with_gaps;
    for (int i = 0; i < 19; ++i)
        with_gaps.add(fmt::format("x,truth.p\n,1\n{},1\n3,0\n{},0\n", 0.1 * i, 4 + i));
    EXPECT_EQ(refused("risk, alpha = 0.2", with_gaps, " missing false"), "E0663");
    // `missing` decides about losses, so a threshold is no good for another
    for (const bool by_risk : {false, true}) {
        const std::string arguments = by_risk ? "risk, alpha = 0.2" : "conformal, alpha = 0.2";
        const std::string thresholds =
            calibrated(fmt::format(kOver, arguments, ""), with_gaps.paths()).thresholds;
        EXPECT_TRUE(checked(fmt::format(kOver, arguments, ""), thresholds).model);
        EXPECT_NE(
            checked(fmt::format(kOver, arguments, " missing false"), thresholds).model.has_value(),
            by_risk);
    }
}

}  // namespace
}  // namespace etlc::tests
