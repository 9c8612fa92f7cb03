// The compiled half of the campaign: many monitors per class, some classes per program.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "campaign.hpp"
#include "compare.hpp"
#include "generated_program.hpp"
#include "loading.hpp"
#include "plan_runner.hpp"
#include "restart_schedule.hpp"
#include "whys.hpp"

namespace etlc::tests {
namespace {

constexpr int kMonitorsPerClass = 20;
constexpr int kClassesPerProgram = 4;
constexpr int kCompiledTries = 150;  // each is a run of the compiler
constexpr plan::Limits kCampaignLimits{64U << 20U, 64U << 20U, 256U << 20U};
/// Every program is built with each set of flags, which must not change verdicts.
const std::vector<Build>& builds() {
    static const std::vector<Build> all{{"Gcc", "g++", "-O1"},
                                        {"GccFastMath", "g++", "-O2 -ffast-math"},
                                        {"ClangSmall", "clang++", "-Os"},
                                        {"GccSanitized", "g++", ETLC_GCC_SANITIZERS}};
    return all;
}

/// Returns the spec without the monitors that are refused alone under the default limits.
std::string without_refused(const std::string& spec, check::Values values) {
    std::string kept;
    std::string monitors;
    std::size_t at = 0;
    while (at < spec.size()) {
        const std::size_t end = spec.find('\n', at) + 1;
        const std::string line = spec.substr(at, end - at);
        at = end;
        const bool is_monitor = line.find("monitor ") < line.find('=');
        if (!is_monitor) {
            kept += line;
            continue;
        }
        const auto model = load(kept + line);
        if (model && PlanRunner(*model, {}, values).refusal().empty()) monitors += line;
    }
    return monitors.empty() ? "" : kept + monitors;
}

/// Every other class of robustness uses --explain.
check::Values explaining(check::Values values, std::uint64_t n) {
    return values == check::Values::robustness && n / 2 % 2 == 0 ? check::Values::sourced : values;
}

Request request_for(const check::Model& model, const Subject& subject, std::uint32_t spec, int t) {
    constexpr std::size_t kLongest = 120;
    const reference::Trace first = subject_trace(model, subject, t, kLongest);
    return {spec, first,
            t % 2 == 0 ? subject_trace(model, subject, t + 1, kLongest)
                       : continuation(model, first, subject.seed)};
}

std::optional<std::string> mismatch_of(const check::Model& model, check::Values values,
                                       const reference::Trace& trace, Observed observed,
                                       WhyTally& whys) {
    observed.dependencies = PlanRunner(model, kCampaignLimits, values).dependencies();
    const Comparison comparison{.on_demand = values == check::Values::boolean};
    const auto verdicts =
        first_mismatch(model, expected_run(model, trace, observed, values), observed, comparison);
    if (verdicts || values != check::Values::sourced) return verdicts;
    return why_mismatch(model, trace, observed, whys);
}

/// Returns the output of the first instance of this class on the trace.
Trial trial_on(check::Values values, const Build& build) {
    return [values, build](const std::string& spec,
                           const reference::Trace& trace) -> std::optional<std::string> {
        const auto model = load(spec);
        if (!model) return {};
        GeneratedProgram program("campaign_shrinking");
        if (!program.add(*model, values) || !program.compile(build)) return "it does not compile";
        const auto result = program.run({{0, trace, trace}});
        if (result.answers.size() != 1) return "it does not run";
        WhyTally unread;
        return mismatch_of(*model, values, trace, result.answers[0][0], unread);
    };
}

void compare(const GeneratedProgram& program, const std::vector<check::Values>& values,
             const std::vector<Request>& requests, const GeneratedProgram::Result& result,
             const Build& build, Tally& tally) {
    std::vector<bool> failed(program.size());
    for (std::size_t n = 0; n < result.answers.size(); ++n) {
        const check::Model& model = program.model(requests[n].spec);
        const check::Values of = values[requests[n].spec];
        for (int run = 0; run < 3 && !failed[requests[n].spec]; ++run) {
            const reference::Trace& trace = run == 0 ? requests[n].first : requests[n].second;
            const auto mismatch = mismatch_of(
                model, of, trace, result.answers[n][static_cast<std::size_t>(run)], tally.whys);
            if (!mismatch) continue;
            failed[requests[n].spec] = true;
            const std::string what = fmt::format("compiled, {}: {}", build.name, *mismatch);
            tally.findings.push_back(shrink({std::string(model.file.text()), trace, what},
                                            trial_on(of, build), kCompiledTries));
        }
    }
}

/// Runs one program; returns the number of formulas in it.
int try_program(const Effort& effort, std::uint64_t first, int formulas, Tally& tally) {
    GeneratedProgram program(fmt::format("campaign_{}", effort.seed));
    std::vector<check::Values> values;
    std::vector<Request> requests;
    int monitors = 0;
    for (std::uint64_t n = 0; n < kClassesPerProgram && monitors < formulas; ++n) {
        const Subject tried =
            subject(effort.seed, first + n, std::min(kMonitorsPerClass, formulas));
        const std::string spec = without_refused(tried.spec(), tried.values);
        const auto model = spec.empty() ? std::nullopt : load(spec);
        const check::Values of = explaining(tried.values, first + n);
        if (!model || !program.add(*model, of)) continue;
        values.push_back(of);
        monitors += static_cast<int>(model->monitors.size());
        for (int t = 0; t < 4; ++t)
            requests.push_back(
                request_for(*model, tried, static_cast<std::uint32_t>(program.size() - 1), t));
    }
    if (requests.empty()) return 0;
    for (int n = 0; n < std::min<int>(effort.builds, static_cast<int>(builds().size())); ++n) {
        const Build& build = builds()[static_cast<std::size_t>(n)];
        if (program.compile(build)) {
            compare(program, values, requests, program.run(requests), build, tally);
            continue;
        }
        tally.findings.push_back({std::string(program.model(0).file.text()),
                                  {},
                                  "a program with this spec does not compile: " + build.name});
        return 0;
    }
    return monitors;
}

}  // namespace

void try_compiled(const Effort& effort, Tally& tally) {
    constexpr std::uint64_t kBeyondPlans = 2'000'000;
    for (std::uint64_t n = kBeyondPlans; tally.compiled < effort.compiled && !tally.enough();
         n += kClassesPerProgram)
        tally.compiled += try_program(effort, n, effort.compiled - tally.compiled, tally);
}

}  // namespace etlc::tests
