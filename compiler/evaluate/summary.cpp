// From what was said and what was true of every episode to figures with intervals.
#include <algorithm>

#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

/// `each`: of every episode; `truths`: by the number that is its duration, or its step's.
Score score(const Bootstrap& bootstrap, const std::vector<Counts>& each,
            const std::vector<LabelRuns>& truths) {
    const auto sum = [&](const Weights& weights) {
        Counts counts;
        for (std::size_t e = 0; e < each.size(); ++e) counts.add(each[e], weights[e]);
        return rates(counts);
    };
    const Rates whole = sum(bootstrap.whole());
    std::vector<Rates> resampled;
    bootstrap.for_each_resample([&](const Weights& weights) { resampled.push_back(sum(weights)); });
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
                 {}};
    for (const Counts& counts : each) result.counts.add(counts);
    result.duration = judged_by_duration(truths);
    return result;
}

/// What was true of whole episodes, by their lengths.
std::vector<LabelRuns> by_length(const std::vector<EpisodeResult>& episodes,
                                 const std::vector<Counts>& each) {
    std::vector<LabelRuns> truths;
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        truths.emplace_back(episodes[e].frames);
        if (each[e].total() > 0) truths[e].add(each[e].positives() > 0 ? Label::yes : Label::no);
    }
    return truths;
}

/// `get(episode)` of every episode.
template <class Get>
auto of_each(const std::vector<EpisodeResult>& episodes, const Get& get) {
    std::vector<decltype(get(episodes[0]))> all;
    for (const EpisodeResult& episode : episodes) all.push_back(get(episode));
    return all;
}

Detection detection(const Bootstrap& bootstrap, const std::vector<EpisodeResult>& episodes,
                    std::size_t monitor) {
    Detection result;
    std::vector<std::int64_t> delays;
    for (const EpisodeResult& episode : episodes) {
        const auto& turn = episode.monitors[monitor].turn;
        if (!turn) continue;
        ++result.turns;
        result.missed += turn->delay ? 0 : 1;
        result.early += turn->delay && *turn->delay < 0 ? 1 : 0;
        if (turn->delay) delays.push_back(*turn->delay);
    }
    if (delays.empty()) return result;
    std::sort(delays.begin(), delays.end());
    const std::size_t n = delays.size();
    result.median = static_cast<double>(delays[(n - 1) / 2] + delays[n / 2]) / 2;
    result.mean = bootstrap.figure([&](const Weights& weights) -> std::optional<double> {
        std::int64_t sum = 0;
        std::int64_t count = 0;
        for (std::size_t e = 0; e < episodes.size(); ++e) {
            const auto& turn = episodes[e].monitors[monitor].turn;
            if (!turn || !turn->delay) continue;
            sum += weights[e] * *turn->delay;
            count += weights[e];
        }
        if (count == 0) return std::nullopt;
        return static_cast<double>(sum) / static_cast<double>(count);
    });
    return result;
}

/// Of the episodes with a positive frame, those of which none is missed: what conformal calibration
/// promises with P >= 1 - alpha.
Figure coverage(const Bootstrap& bootstrap, const std::vector<Counts>& each) {
    return bootstrap.figure([&](const Weights& weights) -> std::optional<double> {
        std::uint64_t with_positives = 0;
        std::uint64_t covered = 0;
        for (std::size_t e = 0; e < each.size(); ++e) {
            if (each[e].positives() == 0) continue;
            with_positives += weights[e];
            covered += each[e].true_positives == each[e].positives() ? weights[e] : 0;
        }
        if (with_positives == 0) return std::nullopt;
        return static_cast<double>(covered) / static_cast<double>(with_positives);
    });
}

PredicateScore predicate_score(const Bootstrap& bootstrap, const Judgement& judgement,
                               std::size_t i) {
    const auto& episodes = judgement.episodes;
    const auto counts =
        of_each(episodes, [&](const EpisodeResult& e) { return e.predicates[i].frames; });
    PredicateScore result;
    result.name = judgement.predicates[i].name;
    result.adaptive = judgement.predicates[i].adaptive;
    result.frames =
        score(bootstrap, counts,
              of_each(episodes, [&](const EpisodeResult& e) { return e.predicates[i].truth; }));
    for (const EpisodeResult& episode : episodes) {
        result.unmeasured += episode.predicates[i].unmeasured;
        result.arrays += episode.predicates[i].from_array ? 1 : 0;
    }
    result.coverage = coverage(bootstrap, counts);
    const episodes::Ranking ranking = ranking_of(judgement, i);
    result.auroc = bootstrap.figure([&](const Weights& weights) { return ranking.auroc(weights); });
    return result;
}

MonitorScore monitor_score(const Bootstrap& bootstrap, const Judgement& judgement, std::size_t m) {
    const auto& episodes = judgement.episodes;
    MonitorScore result;
    result.name = judgement.monitors[m].name;
    result.lacking = judgement.monitors[m].lacking;
    if (!result.lacking.empty()) return result;
    const auto of_monitor = [&](const auto& get) {
        return of_each(episodes, [&](const EpisodeResult& e) { return get(e.monitors[m]); });
    };
    const auto steps = of_monitor([](const MonitorEpisode& e) { return e.steps; });
    const auto whole = of_monitor([](const MonitorEpisode& e) { return e.episode; });
    const auto in_order =
        of_monitor([](const MonitorEpisode& e) { return e.ordering.value_or(Counts{}); });
    result.steps =
        score(bootstrap, steps, of_monitor([](const MonitorEpisode& e) { return e.truth; }));
    result.episodes = score(bootstrap, whole, by_length(episodes, whole));
    result.detection = detection(bootstrap, episodes, m);
    if (judgement.monitors[m].sequential)
        result.ordering = score(bootstrap, in_order, by_length(episodes, in_order));
    return result;
}

}  // namespace

episodes::Ranking ranking_of(const Judgement& judgement, std::size_t predicate) {
    std::vector<episodes::Scored> frames;
    for (std::uint32_t e = 0; e < judgement.episodes.size(); ++e) {
        for (episodes::Scored frame : judgement.episodes[e].predicates[predicate].scored) {
            frame.episode = e;
            frames.push_back(frame);
        }
    }
    return episodes::Ranking(std::move(frames), judgement.fold_of);
}

Evaluation summarise(const Judgement& judgement) {
    Evaluation result;
    result.episodes = judgement.episodes.size();
    result.step_seconds = judgement.step_seconds;
    result.reservations = judgement.reservations;
    result.folds = judgement.folds;
    data::Recordings earlier;
    for (const EpisodeResult& episode : judgement.episodes) {
        result.frames += episode.frames;
        const auto overlap = earlier.find(episode.content);
        earlier.add(episode.content);
        result.repeated += overlap && overlap->equal ? 1 : 0;
        result.overlapping += overlap && !overlap->equal ? 1 : 0;
        result.leaked += episode.leak ? 1 : 0;
    }
    const Bootstrap bootstrap(judgement.episodes.size());
    for (std::size_t i = 0; i < judgement.predicates.size(); ++i)
        result.predicates.push_back(predicate_score(bootstrap, judgement, i));
    for (std::size_t m = 0; m < judgement.monitors.size(); ++m)
        result.monitors.push_back(monitor_score(bootstrap, judgement, m));
    return result;
}

}  // namespace etlc::evaluate
