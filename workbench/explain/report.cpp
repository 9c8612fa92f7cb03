#include "explain/report.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace etlc::explain {

Report report(const Observations& observations, const ir::Program& program,
              const Question& question, const etlmon::Verdict& verdict) {
    Report result{observations, question, verdict.final(),
                  explain(program, observations, question)};
    const Status status = verdict.satisfied()  ? Status::satisfied
                          : verdict.violated() ? Status::violated
                                               : Status::unknown;
    if (status != result.explanation.status)
        throw std::logic_error("an explanation of another verdict than the monitor's");
    return result;
}

std::vector<Interval> intervals(const Observations& observations,
                                const std::vector<Sample>& samples) {
    std::vector<Sample> order = samples;
    std::sort(order.begin(), order.end(), [](const Sample& a, const Sample& b) {
        return std::tie(a.atom, a.step) < std::tie(b.atom, b.step);
    });
    std::vector<Interval> result;
    for (const Sample& sample : order) {
        const bool holds = observations.value(sample).low >= 0;
        const bool is_missing = observations.is_missing(sample);
        const bool goes_on = !result.empty() && result.back().atom == sample.atom &&
                             result.back().last + 1 == sample.step &&
                             result.back().holds == holds && result.back().is_missing == is_missing;
        if (!goes_on) {
            result.push_back(
                {sample.atom, sample.step, sample.step, holds, is_missing, sample.step});
            continue;
        }
        Interval& interval = result.back();
        interval.last = sample.step;
        if (margin(observations, sample) < margin(observations, {sample.atom, interval.closest}))
            interval.closest = sample.step;
    }
    return result;
}

std::string name_of(const Observations& observations, Index atom) {
    if (observations.atoms()[atom].is_predicate) return observations.predicate(atom).shown();
    return observations.model().inputs[observations.atoms()[atom].index].name;
}

const char* word(Status status) {
    return status == Status::satisfied  ? "satisfied"
           : status == Status::violated ? "violated"
                                        : "unknown";
}

float margin(const Observations& observations, Sample sample) {
    if (!observations.atoms()[sample.atom].is_predicate) return 0;
    return std::abs(observations.measured(sample) -
                    observations.predicate(sample.atom).threshold.value);
}

std::vector<Nearest> nearest(const Observations& observations, Sample sample) {
    std::vector<Nearest> result;
    if (!observations.atoms()[sample.atom].is_predicate) return result;
    const std::vector<Index> distances =
        check::measured_targets(observations.model(), observations.predicate(sample.atom));
    for (std::size_t n = 0; n < distances.size(); ++n) {
        const check::Distance& distance = observations.model().distances[distances[n]];
        if (distance.aggregation == check::Aggregation::min)
            result.push_back({&distance, observations.nearest(sample, n)});
    }
    return result;
}

}  // namespace etlc::explain
