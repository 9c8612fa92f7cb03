// campaign [--pairs N] [--planned N] [--compiled N] [--seed S]: the exit status is 1 if something
// disagrees with the reference, or too many formulas are refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "campaign.hpp"
#include "loading.hpp"
#include "random_trace.hpp"

namespace {

using namespace etlc::tests;

/// Greatest fraction of prefix monitors with windows to 40 that may be refused, by depth.
constexpr std::array<double, kDepths> kMayBeRefused{0.005, 0.005, 0.005, 0.05, 0.05};
/// A fraction is checked only from this many formulas on.
constexpr int kEnoughForShare = 1000;

void show(const Finding& finding) {
    fmt::print("\n{}\n---- spec\n{}---- trace\n", finding.mismatch, finding.spec);
    if (const auto model = load(finding.spec)) fmt::print("{}", to_csv(*model, finding.trace));
}

/// Returns whether few enough formulas are refused.
bool show_refused(const char* what, const std::array<Tally::Cell, kDepths>& row,
                  const std::array<double, kDepths>& may_be) {
    bool good = true;
    for (std::size_t depth = 1; depth <= kDepths; ++depth) {
        const Tally::Cell& cell = row[depth - 1];
        const bool too_many = cell.formulas >= kEnoughForShare && cell.share() > may_be[depth - 1];
        good = good && !too_many;
        if (cell.formulas > 0)
            fmt::print("{:28} depth {}: {:6} formulas, {:4} refused for their size, {:5.2f} %{}\n",
                       what, depth, cell.formulas, cell.refused, 100 * cell.share(),
                       too_many ? ": too many" : "");
    }
    return good;
}

int report(const Effort& effort, const Tally& tally) {
    for (const Finding& finding : tally.findings) show(finding);
    bool good = show_refused("prefix, windows to 40", tally.long_windows, kMayBeRefused);
    good &= show_refused("the same, mostly future", tally.mostly_future, kMayBeRefused);
    good &= show_refused("prefix, windows to 6", tally.short_windows, kMayBeRefused);
    good &= show_refused("sliding", tally.sliding, kMayBeRefused);
    good &= show_refused("truth values, all of these", tally.boolean, kMayBeRefused);
    fmt::print(
        "{} pairs of a formula and a trace evaluated, {} formulas compiled in {} builds "
        "({} verdicts said why, {} of them with another distance by rounding), "
        "{} explained ({} for good, {} by samples, {} with what would turn them): "
        "{} mismatches\n",
        tally.pairs, tally.compiled, effort.builds, tally.whys.asked, tally.whys.rounded,
        tally.explained, tally.for_good, tally.with_samples, tally.with_change,
        tally.findings.size());
    good = good && tally.findings.empty();
    // A spec that does not load or a class that does not compile is a failure of GoogleTest,
    // outside of any test.
    good = good && !testing::UnitTest::GetInstance()->ad_hoc_test_result().Failed();
    return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    CLI::App app{"Holds random formulas on random traces to the reference"};
    Effort effort;
    app.add_option("--pairs", effort.pairs, "formula/trace pairs for the evaluator")
        ->capture_default_str();
    app.add_option("--planned", effort.planned, "formulas that are only planned")
        ->capture_default_str();
    app.add_option("--compiled", effort.compiled, "formulas in compiled classes")
        ->capture_default_str();
    app.add_option(
           "--builds", effort.builds,
           "of compiled classes: 1 as is, 2 also -ffast-math, 3 -Os by clang++, 4 sanitizers")
        ->check(CLI::Range(1, 4))
        ->capture_default_str();
    app.add_option("--explained", effort.explained, "pairs whose verdict is explained")
        ->capture_default_str();
    app.add_option("--longest", effort.longest, "steps of the longest trace")
        ->capture_default_str();
    app.add_option("--seed", effort.seed, "another campaign")->capture_default_str();
    app.add_flag("--show-refused", effort.show_refused, "print each formula that is refused");
    CLI11_PARSE(app, argc, argv);
    Tally tally;
    try_pairs(effort, tally);
    try_plans(effort, tally);
    try_compiled(effort, tally);
    try_explanations(effort, tally);
    return report(effort, tally);
}
