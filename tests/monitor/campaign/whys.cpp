#include "whys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "explain/explain.hpp"
#include "plan_runner.hpp"

namespace etlc::tests {
namespace {

using explain::Explanation;
using explain::Observations;
using Why = Observed::Why;

std::vector<check::Index> all(std::size_t count) {
    std::vector<check::Index> result(count);
    std::iota(result.begin(), result.end(), 0);
    return result;
}

Observations observations_of(const check::Model& model, const reference::Trace& trace) {
    Observations result(model, check::Values::robustness, all(model.predicates.size()),
                        all(model.inputs.size()));
    execute::Evaluator evaluator(result.plan());
    for (const reference::Step& step : trace) {
        evaluator.step(samples_of(step));
        result.add(evaluator);
    }
    return result;
}

/// Returns the expected why_NAME(); nothing if there is no sample.
std::optional<Why> expected(const Observations& observations, const Explanation& explanation) {
    if (!explanation.critical) return {};
    const explain::Sample& sample = *explanation.critical;
    const explain::Atom& atom = observations.atoms()[sample.atom];
    Why why{.step = static_cast<std::uint32_t>(sample.step),
            .distance = observations.measured(sample)};
    const etlmon::Value value = observations.value(sample);
    const bool is_false = atom.is_predicate && value.high < 0;
    if (!observations.is_missing(sample))
        why.robustness = etlmon::float_of(is_false ? value.high : value.low);
    if (!atom.is_predicate) {
        why.predicate = observations.model().inputs[atom.index].name;
        return why;
    }
    const check::Predicate& predicate = observations.predicate(sample.atom);
    why.predicate = predicate.shown();
    why.threshold = is_false ? predicate.threshold.value : predicate.threshold.low();
    const bool has_rows = predicate.plain_distance() &&
                          !check::measured_targets(observations.model(), predicate).empty();
    if (has_rows && !observations.is_missing(sample)) why.row = observations.nearest(sample, 0);
    return why;
}

std::string words(const std::optional<Why>& why) {
    if (!why) return "no sample";
    return fmt::format("{} at step {}, robustness {}, distance {}, threshold {}, row {}",
                       why->predicate, why->step, why->robustness, why->distance, why->threshold,
                       why->row);
}

bool same(float a, float b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

/// Robustness is exact, so the distance equals the measured one up to the rounding of the
/// subtraction; it is unknown for bools and infinities.
bool same_distance(const Why& found, const Why& expected) {
    const float a = found.distance, b = expected.distance;
    if (same(a, b)) return true;
    if (std::isnan(a)) return std::isinf(found.robustness);
    const float larger = std::max(std::abs(b), std::abs(expected.threshold));
    return std::abs(a - b) <= larger * std::numeric_limits<float>::epsilon();
}

bool agree(const std::optional<Why>& found, const std::optional<Why>& expected) {
    if (!found || !expected) return found.has_value() == expected.has_value();
    return found->predicate == expected->predicate && found->step == expected->step &&
           same(found->threshold, expected->threshold) && found->row == expected->row &&
           same(found->robustness, expected->robustness) && same_distance(*found, *expected);
}

}  // namespace

std::optional<std::string> why_mismatch(const check::Model& model, const reference::Trace& trace,
                                        const Observed& observed, WhyTally& tally) {
    const ir::Program program = ir::lower(model);
    const Observations observations = observations_of(model, trace);
    const Observed planned = PlanRunner(model, kRoomy).run(trace);
    for (std::size_t step = 0; step < trace.size(); ++step) {
        for (check::Index m = 0; m < model.monitors.size(); ++m) {
            const reference::Verdict& verdict = observed.verdicts[step][m];
            const std::optional<Why>& found = observed.whys[step][m];
            const bool says_why = verdict.status == reference::Status::satisfied ||
                                  verdict.status == reference::Status::violated;
            if (!says_why && !found) continue;
            const std::string where =
                fmt::format("why_{}() at step {}: {}", model.monitors[m].name, step, words(found));
            if (!says_why) return where + ", of a verdict that is unknown";
            const Explanation explanation =
                explain::explain(program, observations, {m, planned.positions[step][m], step});
            if (explanation.for_good != verdict.final) continue;
            const auto wanted = expected(observations, explanation);
            if (!agree(found, wanted)) return where + ", expected " + words(wanted);
            ++tally.asked;
            if (found && !same(found->distance, wanted->distance)) ++tally.rounded;
        }
    }
    return {};
}

}  // namespace etlc::tests
