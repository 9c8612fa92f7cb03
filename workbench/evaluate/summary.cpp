// From what was said and what was true of every episode to figures with intervals.
#include <algorithm>
#include <functional>

#include "episodes/admission/admission.hpp"
#include "episodes/admission/overlaps.hpp"
#include "episodes/ranking/auroc.hpp"
#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

/// `each`: of every episode; `truths`: by the number that is its duration, or its step's.
Score score(const Bootstrap& bootstrap, const std::vector<Counts>& each,
            const EachEpisode& truths) {
    const Rates whole = rates(each, bootstrap.whole())[0];
    std::vector<Rates> resampled;
    bootstrap.for_each_batch([&](const Weights& weights) {
        const auto some = rates(each, weights);
        resampled.insert(resampled.end(), some.begin(), some.end());
    });
    const auto figure = [&](std::optional<double> Rates::*rate) {
        Figure result{whole.*rate, {}};
        if (!result.value || each.size() < 2) return result;
        std::vector<std::optional<double>> values;
        for (const Rates& r : resampled) values.push_back(r.*rate);
        result.interval = percentile_interval(values);
        return result;
    };
    Score result{{},
                 figure(&Rates::f1),
                 figure(&Rates::precision),
                 figure(&Rates::recall),
                 figure(&Rates::agreement),
                 figure(&Rates::gain),
                 {}};
    for (const Counts& counts : each) result.counts.add(counts);
    result.duration = judged_by_duration(truths);
    return result;
}

/// What was true of whole episodes, by their lengths.
EachEpisode by_length(const Judgement& judgement, const std::vector<Counts>& each) {
    return [&](const std::function<void(const LabelRuns&)>& visit) {
        judgement.for_each(judgement.episodes,
                           [&](std::size_t e, const episodes::Recorded& episode) {
                               LabelRuns truth(episode.frames);
                               if (each[e].total() > 0)
                                   truth.add(each[e].positives() > 0 ? Label::yes : Label::no);
                               visit(truth);
                           });
    };
}

/// What was true of frames or steps.
template <class T>
EachEpisode truths(const Judgement& judgement, const data::Spool<T>& of) {
    return [&](const std::function<void(const LabelRuns&)>& visit) {
        judgement.for_each(of, [&](std::size_t, const T& item) { visit(item.truth); });
    };
}

/// What an episode adds to a sum, and to what it is divided by.
struct Part {
    std::int64_t part = 0;
    std::uint64_t whole = 0;
};

/// The part of the whole, in each resample. Nothing where there is no whole.
std::vector<std::optional<double>> shares(const std::vector<Part>& episodes,
                                          const Weights& weights) {
    std::vector<std::int64_t> parts(weights.resamples());
    std::vector<std::uint64_t> wholes(weights.resamples());
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        const auto [part, whole] = episodes[e];
        if (whole == 0) continue;
        for (std::size_t r = 0; r < parts.size(); ++r) {
            parts[r] += part * weights[e][r];
            wholes[r] += whole * weights[e][r];
        }
    }
    std::vector<std::optional<double>> result(parts.size());
    for (std::size_t r = 0; r < parts.size(); ++r)
        if (wholes[r] > 0)
            result[r] = static_cast<double>(parts[r]) / static_cast<double>(wholes[r]);
    return result;
}

Figure share(const Bootstrap& bootstrap, const std::vector<Part>& episodes) {
    return bootstrap.figure([&](const Weights& weights) { return shares(episodes, weights); });
}

Detection detection(const Bootstrap& bootstrap, const std::vector<std::optional<Turn>>& turns) {
    Detection result;
    std::vector<std::int64_t> delays;
    std::vector<Part> detected(turns.size());
    for (std::size_t e = 0; e < turns.size(); ++e) {
        const auto& turn = turns[e];
        if (!turn) continue;
        ++result.turns;
        result.missed += turn->delay ? 0 : 1;
        result.early += turn->delay && *turn->delay < 0 ? 1 : 0;
        if (!turn->delay) continue;
        delays.push_back(*turn->delay);
        detected[e] = {*turn->delay, 1};
    }
    if (delays.empty()) return result;
    std::sort(delays.begin(), delays.end());
    const std::size_t n = delays.size();
    result.median = static_cast<double>(delays[(n - 1) / 2] + delays[n / 2]) / 2;
    result.mean = share(bootstrap, detected);
    return result;
}

/// Of the episodes with a positive frame, those of which none is missed: what conformal calibration
/// promises with P >= 1 - alpha.
Figure coverage(const Bootstrap& bootstrap, const std::vector<Counts>& each) {
    std::vector<Part> covered;
    covered.reserve(each.size());
    for (const Counts& counts : each)
        covered.push_back({counts.true_positives == counts.positives() ? 1 : 0,
                           counts.positives() > 0 ? std::uint64_t{1} : 0});
    return share(bootstrap, covered);
}

PredicateScore predicate_score(const Bootstrap& bootstrap, const Judgement& judgement,
                               std::size_t i) {
    const Judgement::Predicate& predicate = judgement.predicates[i];
    PredicateScore result;
    result.name = predicate.name;
    result.adaptive = predicate.adaptive;
    std::vector<Counts> counts;
    counts.reserve(judgement.place.size());
    judgement.for_each(predicate.episodes, [&](std::size_t, const PredicateEpisode& episode) {
        counts.push_back(episode.frames);
        result.unmeasured += episode.unmeasured;
        result.arrays += episode.from_array ? 1 : 0;
    });
    result.frames = score(bootstrap, counts, truths(judgement, predicate.episodes));
    result.coverage = coverage(bootstrap, counts);
    result.auroc = bootstrap.figure(
        [&](const Weights& weights) { return episodes::auroc(predicate.frames, weights); });
    return result;
}

MonitorScore monitor_score(const Bootstrap& bootstrap, const Judgement& judgement, std::size_t m) {
    const Judgement::Monitor& monitor = judgement.monitors[m];
    MonitorScore result;
    result.name = monitor.name;
    result.lacking = monitor.lacking;
    if (!result.lacking.empty()) return result;
    const auto of_each = [&](const auto& get) { return judgement.each(monitor.episodes, get); };
    const auto judged = [&](const std::vector<Counts>& each) {
        return score(bootstrap, each, by_length(judgement, each));
    };
    result.steps = score(bootstrap, of_each([](const MonitorEpisode& e) { return e.steps; }),
                         truths(judgement, monitor.episodes));
    result.episodes = judged(of_each([](const MonitorEpisode& e) { return e.episode; }));
    result.detection =
        detection(bootstrap, of_each([](const MonitorEpisode& e) { return e.turn; }));
    if (monitor.sequential)
        result.ordering =
            judged(of_each([](const MonitorEpisode& e) { return e.ordering.value_or(Counts{}); }));
    return result;
}

}  // namespace

Evaluation summarise(const Judgement& judgement) {
    Evaluation result;
    result.episodes = judgement.episodes.size();
    result.step_seconds = judgement.step_seconds;
    result.reservations = judgement.reservations;
    result.folds = judgement.folds;
    episodes::Identities in_order;  // of the request, in which folds do not come
    if (!judgement.folds.empty())
        judgement.for_each(judgement.episodes, [&](std::size_t, const episodes::Recorded& episode) {
            in_order.add(episode);
        });
    const auto alike = episodes::overlaps(judgement.folds.empty() ? judgement.episodes : in_order);
    result.repeated = alike.repeated;
    result.overlapping = alike.overlapping;
    const episodes::LeakEvidence evidence(judgement.episodes);
    judgement.for_each(judgement.episodes, [&](std::size_t, const episodes::Recorded& episode) {
        result.frames += episode.frames;
        result.leaked += evidence.of(episode) ? 1 : 0;
    });
    const Bootstrap bootstrap(judgement.episodes.size());
    for (std::size_t i = 0; i < judgement.predicates.size(); ++i)
        result.predicates.push_back(predicate_score(bootstrap, judgement, i));
    for (std::size_t m = 0; m < judgement.monitors.size(); ++m)
        result.monitors.push_back(monitor_score(bootstrap, judgement, m));
    return result;
}

}  // namespace etlc::evaluate
