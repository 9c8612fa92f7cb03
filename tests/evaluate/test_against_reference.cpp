// Compares evaluations of random episodes with counts from the reference semantics: of the spec,
// and of a spec in which every predicate is replaced by its truth.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "evaluated.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {
namespace {

using evaluate::Counts;
using evaluate::Label;
using reference::Status;

const std::vector<std::string> kFormulas = {
    "F p",
    "G !q",
    "F p && G !q",
    "F (p && F q)",
    "F (p && F (q && F p))",
    "G (p -> F[0, 4] q)",
    "p U q",
    "G (q -> H[0, 3] !p)",
    "F G[0, 2] p",
    "!p W (q && c)",
    "G[2, 6] (p <-> q)",
    "F (p && c) || G !(v > 1)",
    "X p && F[3, 8] (q S p)",
    "v > 0 R p",
    "F (held_p && F (after && p))",
    "G (later || q)",
    "!held_p U after",
};
/// Lets with the formulas of their truths; an empty one means that it has none.
const std::vector<std::array<std::string, 3>> kLets = {
    {"held_p", "held[2] p", "p"},
    {"after", "!q && O[0, 4] p", "rise p || (c && held[1] q)"},
    {"alias", "q", "p && q"},
    {"later", "after S (alias && v > 1)", ""},
};
const std::vector<std::string> kSliding = {
    "G[0, 3] p", "p && !q", "p U[0, 5] q", "c -> F[1, 2] p",        "O[0, 3] q && F[0, 2] p",
    "held_p",    "after",   "alias",       "later && F[0, 3] after"};
constexpr std::size_t kOfLets = 14;   ///< the sequential formula over lets
constexpr std::size_t kFirstLet = 5;  ///< of the sliding monitors that are lets with a truth

/// The truths of p and q depend on x and y, the predicates on u and w. With `truths` the spec has
/// the truths in place of the predicates and of the lets that have one.
std::string spec(bool truths) {
    std::string text = "spec t; input u, w, x, y, v : f32; input c : bool;";
    text +=
        truths
            ? "predicate p = x > 0; predicate q = y <= 0.25;"
            : "predicate p = u > 0; predicate q = w <= 0.25; truth p = x > 0; truth q = y <= 0.25;";
    for (const auto& [name, formula, truth] : kLets) {
        text += fmt::format("let {} = {};", name, truths && !truth.empty() ? truth : formula);
        if (!truths && !truth.empty()) text += fmt::format("truth {} = {};", name, truth);
    }
    for (std::size_t i = 0; i < kFormulas.size(); ++i)
        text += fmt::format("monitor m{} = {};", i, kFormulas[i]);
    for (std::size_t i = 0; i < kSliding.size(); ++i)
        text += fmt::format("sliding monitor s{} = {};", i, kSliding[i]);
    return text;
}

struct Episode {
    std::string csv = "u,w,x,y,v,c\n";
    reference::Trace trace;
};

/// u and w mostly agree with x and y; numbers avoid the thresholds, and samples may be missing.
Episode random_episode(std::mt19937& random, bool missing) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Episode episode;
    const std::size_t steps = 1 + random() % 25;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto draw = [&](double keep) {
            double value = 0;
            do value = std::round(uniform(random) * 64) / 64;
            while (std::abs(value - keep) < 0.01);
            return value;
        };
        const double x = draw(0);
        const double y = draw(0.25);
        std::vector<double> row = {random() % 5 == 0 ? draw(0) : x,
                                   random() % 5 == 0 ? draw(0.25) : y,
                                   x,
                                   y,
                                   2 * draw(0.5),
                                   static_cast<double>(random() % 2)};
        if (row[4] == 0) row[4] = 1.5;
        reference::Step step;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const bool absent = missing && random() % 12 == 0;
            episode.csv +=
                fmt::format("{}{}", c == 0 ? "" : ",", absent ? "" : fmt::format("{}", row[c]));
            step.push_back(absent ? std::vector<double>{} : std::vector<double>{row[c]});
        }
        episode.csv += "\n";
        episode.trace.push_back(std::move(step));
    }
    return episode;
}

Label label(Status status) {
    return status == Status::satisfied  ? Label::yes
           : status == Status::violated ? Label::no
                                        : Label::unknown;
}

/// Returns all verdicts of a monitor for an episode.
std::vector<Label> verdicts(const reference::Run& run, std::size_t monitor, std::uint32_t horizon) {
    std::vector<Label> labels;
    for (const auto& step : run.verdicts)
        if (step[monitor].status != Status::undecided)
            labels.push_back(label(step[monitor].status));
    for (std::uint32_t call = 0; call < horizon; ++call)
        if (run.finish[call][monitor].status != Status::undecided)
            labels.push_back(label(run.finish[call][monitor].status));
    return labels;
}

TEST(Evaluation, IsThatOfTheReference) {
    std::mt19937 random(7);
    const check::Model model = model_of(spec(false));
    const check::Model true_model = model_of(spec(true));
    const std::size_t monitors = kFormulas.size() + kSliding.size();
    for (const bool missing : {false, true}) {
        std::vector<std::string> texts;
        std::vector<Counts> steps(monitors);
        std::vector<Counts> episodes(monitors);
        std::vector<Counts> ordering(2);
        std::vector<Counts> predicates(2);
        for (int e = 0; e < 60; ++e) {
            const Episode episode = random_episode(random, missing);
            texts.push_back(episode.csv);
            const auto predicted = reference::evaluate(model, episode.trace);
            const auto actual = reference::evaluate(true_model, episode.trace);
            for (std::size_t m = 0; m < monitors; ++m) {
                const std::uint32_t horizon = model.monitors[m].horizon;
                const std::vector<Label> predictions = verdicts(predicted, m, horizon);
                const std::vector<Label> truths = verdicts(actual, m, horizon);
                ASSERT_EQ(predictions.size(), episode.trace.size());
                for (std::size_t i = 0; i < predictions.size(); ++i)
                    steps[m].add(predictions[i], truths[i]);
                const bool sliding = model.monitors[m].sliding;
                const auto one = [&](const std::vector<Label>& labels) {
                    return sliding ? *std::min_element(labels.begin(), labels.end())
                                   : labels.back();
                };
                episodes[m].add(one(predictions), one(truths));
                // F (p && F q), F (p && F (q && F p))
                const bool sequential = m == 3 || m == 4;
                bool p_visited = false;
                bool q_visited = false;
                for (const reference::Step& step : episode.trace) {
                    p_visited |= !step[2].empty() && step[2][0] > 0;
                    q_visited |= !step[3].empty() && step[3][0] <= 0.25;
                }
                if (sequential && p_visited && q_visited)
                    ordering[m - 3].add(one(predictions), one(truths));
            }
            for (const reference::Step& step : episode.trace) {
                const auto holds = [&](std::size_t input, bool above) {
                    if (step[input].empty()) return Label::unknown;
                    return (above ? step[input][0] > 0 : step[input][0] <= 0.25) ? Label::yes
                                                                                 : Label::no;
                };
                predicates[0].add(holds(0, true), holds(2, true));
                predicates[1].add(holds(1, false), holds(3, false));
            }
        }
        const evaluate::Evaluation found = evaluated(spec(false), texts, 2);
        ASSERT_EQ(found.monitors.size(), monitors);
        for (std::size_t m = 0; m < monitors; ++m) {
            EXPECT_EQ(found.monitors[m].steps.counts, steps[m]) << found.monitors[m].name;
            EXPECT_EQ(found.monitors[m].episodes.counts, episodes[m]) << found.monitors[m].name;
            EXPECT_EQ(found.monitors[m].ordering.has_value(), m == 3 || m == 4 || m == kOfLets);
            if (found.monitors[m].ordering && m != kOfLets) {
                EXPECT_EQ(found.monitors[m].ordering->counts, ordering[m - 3]);
                EXPECT_GT(ordering[m - 3].total(), 10U);
            }
        }
        ASSERT_EQ(found.predicates.size(), 5U);
        for (std::size_t p = 0; p < 2; ++p)
            EXPECT_EQ(found.predicates[p].frames.counts, predicates[p]);
        // By frames a let is what a sliding monitor of it is by positions.
        for (std::size_t l = 0; l < 3; ++l) {
            EXPECT_EQ(found.predicates[2 + l].name, kLets[l][0]);
            EXPECT_EQ(found.predicates[2 + l].frames.counts,
                      steps[kFormulas.size() + kFirstLet + l]);
        }
        const auto json = [](const evaluate::Evaluation& evaluation) {
            return evaluate::json({{{"t.etl", evaluation, {}}}});
        };
        EXPECT_EQ(json(found), json(evaluated(spec(false), texts, 5)));
    }
}

}  // namespace
}  // namespace etlc::tests
