#include "evaluate/differences.hpp"

#include <algorithm>

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

Figure less(const Bootstrap& bootstrap, const auto& second, const auto& first) {
    return bootstrap.figure([&](const Weights& weights) -> std::optional<double> {
        const std::optional<double> a = first(weights);
        const std::optional<double> b = second(weights);
        if (!a || !b) return std::nullopt;
        return *b - *a;
    });
}

/// Both judgements, at what both have.
class Pair {
public:
    Pair(const Judgement& first, const Judgement& second)
        : first_(first), second_(second), bootstrap_(first.episodes.size()) {}

    Difference of_predicate(std::size_t a, std::size_t b) const {
        const auto of = [](const EpisodeResult& e, std::size_t i) -> const PredicateEpisode& {
            return e.predicates[i];
        };
        Difference result = compared(
            a, b, [&](const auto& e, std::size_t i) -> const LabelRuns& { return of(e, i).truth; },
            [&](const auto& e, std::size_t i) -> const Counts& { return of(e, i).frames; });
        result.name = first_.predicates[a].name;
        result.level = "frames";
        if (result.other_truths > 0) return result;
        const episodes::Ranking ranking_a = ranking_of(first_, a);
        const episodes::Ranking ranking_b = ranking_of(second_, b);
        result.auroc = less(
            bootstrap_, [&](const Weights& weights) { return ranking_b.auroc(weights); },
            [&](const Weights& weights) { return ranking_a.auroc(weights); });
        return result;
    }

    std::vector<Difference> of_monitor(std::size_t a, std::size_t b) const {
        const auto of = [](const EpisodeResult& e, std::size_t m) -> const MonitorEpisode& {
            return e.monitors[m];
        };
        const auto whole = [&](const auto& e, std::size_t m) -> const Counts& {
            return of(e, m).episode;
        };
        std::vector<Difference> both = {
            compared(
                a, b,
                [&](const auto& e, std::size_t m) -> const LabelRuns& { return of(e, m).truth; },
                [&](const auto& e, std::size_t m) -> const Counts& { return of(e, m).steps; }),
            compared(
                a, b,
                [&](const auto& e, std::size_t m) {
                    return std::pair(whole(e, m).positives(), whole(e, m).negatives());
                },
                whole)};
        both[0].level = "steps";
        both[1].level = "episodes";
        for (Difference& difference : both) {
            difference.of_monitor = true;
            difference.name = first_.monitors[a].name;
        }
        return both;
    }

private:
    /// `a`, `b`: in the first and in the second. `truth(episode, index)`, `counts(episode, index)`.
    Difference compared(std::size_t a, std::size_t b, const auto& truth, const auto& counts) const {
        Difference result;
        for (std::size_t e = 0; e < first_.episodes.size(); ++e)
            result.other_truths +=
                truth(first_.episodes[e], a) == truth(second_.episodes[e], b) ? 0 : 1;
        if (result.other_truths > 0) return result;
        const auto figure = [&](std::optional<double> Rates::*rate) {
            const auto of = [&](const Judgement& judgement, std::size_t index) {
                return [&judgement, &counts, index, rate](const Weights& weights) {
                    Counts sum;
                    for (std::size_t e = 0; e < weights.size(); ++e)
                        sum.add(counts(judgement.episodes[e], index), weights[e]);
                    return rates(sum).*rate;
                };
            };
            return less(bootstrap_, of(second_, b), of(first_, a));
        };
        result.f1 = figure(&Rates::f1);
        result.precision = figure(&Rates::precision);
        result.recall = figure(&Rates::recall);
        result.agreement = figure(&Rates::agreement);
        return result;
    }

    const Judgement& first_;
    const Judgement& second_;
    Bootstrap bootstrap_;
};

}  // namespace

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
