// The evaluator's half of the campaign.
#include <fmt/format.h>

#include "campaign.hpp"
#include "compare.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "restart_schedule.hpp"

namespace etlc::tests {
namespace {

constexpr int kTracesPerFormula = 3;
constexpr int kShrinkingTries = 3000;

Trial trial_on(check::Values values) {
    return [values](const std::string& spec,
                    const reference::Trace& trace) -> std::optional<std::string> {
        const auto model = load(spec);
        if (!model) return {};
        PlanRunner runner(*model, {}, values);
        if (!runner.refusal().empty()) return {};
        const Observed observed = runner.run(trace);
        return first_mismatch(*model, expected_run(*model, trace, observed, values), observed, {});
    };
}

/// Returns whether the formula is planned; counts refusals.
bool planned(const Effort& effort, const Subject& subject, const PlanRunner& runner, Tally& tally) {
    Tally::Cell& cell = tally.cell(subject);
    ++cell.formulas;
    if (runner.refusal().empty()) return true;
    ++cell.refused;
    if (effort.show_refused) fmt::print("// {}\n{}\n", runner.refusal(), subject.spec());
    return false;
}

void try_formula(const Effort& effort, const Subject& subject, Tally& tally) {
    const auto model = load(subject.spec());
    if (!model) return;
    PlanRunner runner(*model, {}, subject.values);
    if (!planned(effort, subject, runner, tally)) return;
    for (int t = 0; t <= kTracesPerFormula; ++t) {
        reference::Trace trace = subject_trace(*model, subject, t, effort.longest);
        // Bounds hold over every continuation: the last trace continues a prefix of the first.
        if (t == kTracesPerFormula)
            trace = continuation(*model, subject_trace(*model, subject, 0, effort.longest),
                                 subject.seed);
        ++tally.pairs;
        const Observed observed = runner.run(trace);
        const auto mismatch = first_mismatch(
            *model, expected_run(*model, trace, observed, subject.values), observed, {});
        if (!mismatch) continue;
        tally.findings.push_back(
            shrink({subject.spec(), trace, *mismatch}, trial_on(subject.values), kShrinkingTries));
        return;
    }
}

}  // namespace

void try_pairs(const Effort& effort, Tally& tally) {
    for (std::uint64_t n = 0; tally.pairs < effort.pairs && !tally.enough(); ++n)
        try_formula(effort, subject(effort.seed, n, 1), tally);
}

void try_plans(const Effort& effort, Tally& tally) {
    constexpr std::uint64_t kBeyondPairs = 1'000'000;
    for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(effort.planned); ++n) {
        const Subject tried = subject(effort.seed, kBeyondPairs + n, 1);
        if (const auto model = load(tried.spec()))
            planned(effort, tried, PlanRunner(*model, {}, tried.values), tally);
    }
}

}  // namespace etlc::tests
