#include <algorithm>

#include "episodes/ranking/auroc.hpp"
#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

template <class Named>
std::optional<std::size_t> find(const std::vector<Named>& all, const std::string& name) {
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
    if (at == all.end()) return std::nullopt;
    return static_cast<std::size_t>(at - all.begin());
}

/// Compares what two judgements have in common.
class Pair {
public:
    Pair(const Judgement& first, const Judgement& second)
        : first_(first), second_(second), bootstrap_(first.groups) {}

    Difference of_predicate(std::size_t a, std::size_t b) const {
        const Judgement::Predicate& first = first_.predicates[a];
        const Judgement::Predicate& second = second_.predicates[b];
        const auto counts = [](const PredicateEpisode& episode) { return episode.frames; };
        Difference result = compared(
            first.episodes, second.episodes,
            [](const PredicateEpisode& x, const PredicateEpisode& y) { return x.truth == y.truth; },
            counts);
        result.name = first.name;
        result.level = "frames";
        if (result.other_truths > 0) return result;
        result.auroc = less(
            bootstrap_,
            [&](const Weights& weights) { return episodes::auroc(second.frames, weights); },
            [&](const Weights& weights) { return episodes::auroc(first.frames, weights); });
        return result;
    }

    std::vector<Difference> of_monitor(std::size_t a, std::size_t b) const {
        const Judgement::Monitor& first = first_.monitors[a];
        const Judgement::Monitor& second = second_.monitors[b];
        const auto same_outcome = [](const MonitorEpisode& x, const MonitorEpisode& y) {
            return x.episode.positives() == y.episode.positives() &&
                   x.episode.negatives() == y.episode.negatives();
        };
        std::vector<Difference> both = {
            compared(
                first.episodes, second.episodes,
                [](const MonitorEpisode& x, const MonitorEpisode& y) { return x.truth == y.truth; },
                [](const MonitorEpisode& episode) { return episode.steps; }),
            compared(first.episodes, second.episodes, same_outcome,
                     [](const MonitorEpisode& episode) { return episode.episode; })};
        both[0].level = "steps";
        both[1].level = "episodes";
        for (Difference& difference : both) {
            difference.of_monitor = true;
            difference.name = first.name;
        }
        return both;
    }

private:
    /// `same_truth(a, b)` compares the truths of an episode; `counts(a)` returns its counts.
    template <class T>
    Difference compared(const data::Spool<T>& first, const data::Spool<T>& second,
                        const auto& same_truth, const auto& counts) const {
        Difference result;
        for (std::size_t e = 0; e < first_.place.size(); ++e)
            result.other_truths +=
                same_truth(first[first_.place[e]], second[second_.place[e]]) ? 0 : 1;
        if (result.other_truths > 0) return result;
        const std::vector<Counts> of_first = first_.each(first, counts);
        const std::vector<Counts> of_second = second_.each(second, counts);
        static_cast<ByRate<Figure>&>(result) = by_rate([&](Rate rate) {
            const auto of = [rate](const std::vector<Counts>& each) {
                return [&each, rate](const Weights& weights) {
                    std::vector<std::optional<double>> values;
                    for (const Rates& one : rates(each, weights)) values.push_back(one.*rate);
                    return values;
                };
            };
            return less(bootstrap_, of(of_second), of(of_first));
        });
        return result;
    }

    const Judgement& first_;
    const Judgement& second_;
    Bootstrap bootstrap_;
};

}  // namespace

Figure less(const Bootstrap& bootstrap, const Statistic& second, const Statistic& first) {
    return bootstrap.figure([&](const Weights& weights) {
        std::vector<std::optional<double>> result = second(weights);
        const std::vector<std::optional<double>> before = first(weights);
        for (std::size_t r = 0; r < result.size(); ++r)
            if (result[r] && before[r])
                *result[r] -= *before[r];
            else
                result[r].reset();
        return result;
    });
}

std::vector<Difference> differences(const Judgement& first, const Judgement& second) {
    const Pair pair(first, second);
    std::vector<Difference> all;
    for (std::size_t a = 0; a < first.predicates.size(); ++a)
        if (const auto b = find(second.predicates, first.predicates[a].name))
            all.push_back(pair.of_predicate(a, *b));
    for (std::size_t a = 0; a < first.monitors.size(); ++a) {
        const auto b = find(second.monitors, first.monitors[a].name);
        if (!b || !first.monitors[a].lacking.empty() || !second.monitors[*b].lacking.empty())
            continue;
        const auto both = pair.of_monitor(a, *b);
        all.insert(all.end(), both.begin(), both.end());
    }
    return all;
}

}  // namespace etlc::evaluate
