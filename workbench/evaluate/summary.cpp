// Turns predictions and truths of all episodes into figures with intervals.
#include <algorithm>
#include <functional>

#include "episodes/admission/admission.hpp"
#include "episodes/ranking/auroc.hpp"
#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

/// Computes the rates of `each` episode's counts; `truths` are labels by duration or step.
Score score(const Bootstrap& bootstrap, const std::vector<Counts>& each,
            const EachEpisode& truths) {
    const Rates whole = rates(each, bootstrap.whole())[0];
    std::vector<Rates> resampled;
    bootstrap.for_each_batch([&](const Weights& weights) {
        const auto some = rates(each, weights);
        resampled.insert(resampled.end(), some.begin(), some.end());
    });
    const auto figure = [&](Rate rate) {
        Figure result{whole.*rate, {}};
        if (!result.value || bootstrap.groups() < 2) return result;
        std::vector<std::optional<double>> values;
        for (const Rates& r : resampled) values.push_back(r.*rate);
        result.interval = percentile_interval(values);
        return result;
    };
    Score result{by_rate(figure), {}, figure(&Rates::gain), {}};
    for (const Counts& counts : each) result.counts.add(counts);
    result.duration = judged_by_duration(truths);
    return result;
}

/// Returns the labels of whole episodes by their lengths.
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

/// Returns the labels of frames or steps.
template <class T>
EachEpisode truths(const Judgement& judgement, const data::Spool<T>& of) {
    return [&](const std::function<void(const LabelRuns&)>& visit) {
        judgement.for_each(of, [&](std::size_t, const T& item) { visit(item.truth); });
    };
}

Detection detection(const Bootstrap& bootstrap, const std::vector<std::optional<Turn>>& turns) {
    Detection result;
    std::vector<std::int64_t> delays;
    std::vector<Fraction> detected(turns.size());
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

Coverage coverage(const Bootstrap& bootstrap, const std::vector<Counts>& each) {
    std::vector<Fraction> positives;
    std::vector<Fraction> negatives;
    const auto covered = [](std::uint64_t wrong, std::uint64_t all) {
        return Fraction{all > 0 && wrong == 0 ? 1 : 0, all > 0 ? std::uint64_t{1} : 0};
    };
    for (const Counts& counts : each) {
        positives.push_back(covered(counts.false_negatives, counts.positives()));
        negatives.push_back(covered(counts.false_positives, counts.negatives()));
    }
    return {share(bootstrap, positives), share(bootstrap, negatives)};
}

/// Returns the verdicts on variants of all kinds.
Counts on_all_variants(const MonitorEpisode& episode) {
    Counts sum;
    for (const Counts& kind : episode.variants) sum.add(kind);
    return sum;
}

/// Computes the rates on variants, resampled with their episodes.
Score of_variants(const Bootstrap& bootstrap, const std::vector<Counts>& each) {
    Score result = score(bootstrap, each, [](const auto&) {});
    result.of_variants = true;
    return result;
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
    std::vector<Judged> judged;
    judged.reserve(judgement.place.size());
    judgement.for_each(judgement.episodes, [&](std::size_t e, const episodes::Recorded& episode) {
        const MonitorEpisode said = monitor.episodes[judgement.place[e]];
        judged.push_back({episode.outcome, episode.frames, judgement.fold_of[e],
                          judgement.groups.of(e), said.alarm, said.least_upper});
    });
    result.outcomes = outcome_score(bootstrap, judged, judgement.groups.are_named());
    if (!result.lacking.empty()) return result;
    const auto of_each = [&](const auto& get) { return judgement.each(monitor.episodes, get); };
    const auto by_verdict = [&](const std::vector<Counts>& each) {
        return score(bootstrap, each, by_length(judgement, each));
    };
    const std::vector<Counts> steps = of_each([](const MonitorEpisode& e) { return e.steps; });
    result.steps = score(bootstrap, steps, truths(judgement, monitor.episodes));
    result.coverage = coverage(bootstrap, steps);
    result.episodes = by_verdict(of_each([](const MonitorEpisode& e) { return e.episode; }));
    result.detection =
        detection(bootstrap, of_each([](const MonitorEpisode& e) { return e.turn; }));
    for (std::size_t v = 0; v < judgement.variants.size(); ++v)
        result.variants.push_back(of_variants(
            bootstrap, of_each([v](const MonitorEpisode& e) { return e.variants[v]; })));
    if (!judgement.variants.empty())
        result.variants.push_back(of_variants(bootstrap, of_each(on_all_variants)));
    if (monitor.sequential)
        result.ordering = by_verdict(
            of_each([](const MonitorEpisode& e) { return e.ordering.value_or(Counts{}); }));
    return result;
}

/// Returns the share of the predictions with known truth that are wrong or unknown.
double share_not_right(const Counts& predictions) {
    const auto agreement = rates(predictions).agreement;
    return agreement ? 1 - *agreement : 0;
}

/// Keeps the earlier error; ties keep the first.
void note(std::optional<EpisodeRow::Error>& first, const std::optional<std::uint64_t>& step,
          const std::string& name, bool of_monitor) {
    if (step && (!first || *step < first->step)) first = {*step, name, of_monitor};
}

EpisodeRow row_of(const Judgement& judgement, std::size_t e) {
    const std::uint32_t place = judgement.place[e];
    const episodes::Recorded episode = judgement.episodes[place];
    EpisodeRow row;
    row.path = episode.path;
    if (!judgement.folds.empty()) row.fold = judgement.fold_of[e] + 1;
    row.frames = episode.frames;
    row.outcome = episode.outcome.kind;
    for (std::size_t i = 0; i < judgement.predicates.size(); ++i) {
        const PredicateEpisode predicate = judgement.predicates[i].episodes[place];
        const std::string& name = judgement.predicates[i].name;
        row.predicates.emplace_back(name, predicate.frames);
        row.predictions.add(predicate.frames);
        note(row.first_error, predicate.first_error, name, false);
    }
    const bool predicates_err = row.first_error.has_value();
    for (std::size_t m = 0; m < judgement.monitors.size(); ++m) {
        const MonitorEpisode monitor = judgement.monitors[m].episodes[place];
        const std::string& name = judgement.monitors[m].name;
        // Without a truth the outcome tells whether there should be an alarm.
        using Kind = episodes::Outcome::Kind;
        const Kind outcome = episode.outcome.kind;
        const bool by_outcome = !judgement.monitors[m].lacking.empty() &&
                                outcome == (monitor.alarm ? Kind::success : Kind::failure);
        if (monitor.episode.wrong() > 0 || by_outcome) row.wrong.push_back(name);
        if (monitor.alarm) row.alarms.emplace_back(name, *monitor.alarm);
        if (judgement.predicates.empty()) row.predictions.add(monitor.steps);
        if (!predicates_err) note(row.first_error, monitor.first_error, name, true);
    }
    return row;
}

bool has_outcomes(const Judgement& judgement) {
    bool found = false;
    judgement.for_each(judgement.episodes, [&](std::size_t, const episodes::Recorded& episode) {
        found |= episode.outcome.kind != episodes::Outcome::Kind::none;
    });
    return found;
}

}  // namespace

std::vector<std::pair<std::string, Rates>> baselines(const Score& score) {
    const Counts& c = score.counts;
    std::vector<std::pair<std::string, Rates>> all = {
        {"always_true", rates_of_constant(true, c.positives(), c.total())},
        {"always_false", rates_of_constant(false, c.positives(), c.total())}};
    if (!score.of_variants) all.emplace_back("duration", rates(score.duration.value_or(Counts{})));
    return all;
}

Evaluation summarise(const Judgement& judgement, unsigned jobs) {
    Evaluation result{judgement};
    result.episodes = judgement.episodes.size();
    if (judgement.groups.are_named()) result.groups = judgement.groups.count();
    episodes::Identities in_order;  // in the order of the request, unlike the folds
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
    const Bootstrap bootstrap(judgement.groups, jobs);
    for (std::size_t i = 0; i < judgement.predicates.size(); ++i)
        result.predicates.push_back(predicate_score(bootstrap, judgement, i));
    for (std::size_t m = 0; m < judgement.monitors.size(); ++m)
        result.monitors.push_back(monitor_score(bootstrap, judgement, m));
    return result;
}

EpisodeCounts counts_by_frames(const Judgement& judgement, std::size_t predicate) {
    return {judgement.each(judgement.predicates[predicate].episodes,
                           [](const PredicateEpisode& one) { return one.frames; }),
            {}};
}

EpisodeCounts counts_by_truth(const Judgement& judgement, std::size_t monitor,
                              Counts MonitorEpisode::*of_episode) {
    const auto& all = judgement.monitors[monitor].episodes;
    return {judgement.each(all, [=](const MonitorEpisode& one) { return one.*of_episode; }),
            judgement.each(all, on_all_variants)};
}

EpisodeCounts counts_by_outcome(const Judgement& judgement, std::size_t monitor) {
    using Kind = episodes::Outcome::Kind;
    const Kind success = has_outcomes(judgement) ? Kind::success : Kind::none;
    EpisodeCounts result;
    judgement.for_each(judgement.episodes, [&](std::size_t e, const episodes::Recorded& episode) {
        const MonitorEpisode said = judgement.monitors[monitor].episodes[judgement.place[e]];
        const Kind outcome = episode.outcome.kind;
        result.own.emplace_back().add(said.alarm ? Label::yes : Label::no,
                                      outcome == success         ? Label::no
                                      : outcome == Kind::failure ? Label::yes
                                                                 : Label::unknown);
    });
    return result;
}

Statistic statistic(const EpisodeCounts& counts, Rate rate) {
    return [counts, rate](const Weights& weights) {
        const std::vector<Rates> on_episodes = rates(counts.own, weights);
        std::vector<std::optional<double>> values;
        for (const Rates& one : on_episodes) values.push_back(one.*rate);
        if (counts.on_variants.empty()) return values;
        const std::vector<Rates> on_variants = rates(counts.on_variants, weights);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = mean(values[i], on_variants[i].*rate);
        return values;
    };
}

std::optional<double> f1_of_duration(const Judgement& judgement, std::size_t predicate) {
    const auto judged =
        judged_by_duration(truths(judgement, judgement.predicates[predicate].episodes));
    return judged ? rates(*judged).f1 : std::nullopt;
}

std::vector<EpisodeRow> by_episode(const Judgement& judgement) {
    std::vector<EpisodeRow> rows;
    for (std::size_t e = 0; e < judgement.place.size(); ++e) rows.push_back(row_of(judgement, e));
    std::stable_sort(rows.begin(), rows.end(), [](const EpisodeRow& a, const EpisodeRow& b) {
        return std::pair(a.wrong.size(), share_not_right(a.predictions)) >
               std::pair(b.wrong.size(), share_not_right(b.predictions));
    });
    return rows;
}

// ---- two specs on the same episodes -------------------------------------------------------------

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
        const EpisodeCounts of_first{first_.each(first, counts), {}};
        const EpisodeCounts of_second{second_.each(second, counts), {}};
        static_cast<ByRate<Figure>&>(result) = by_rate([&](Rate rate) {
            return less(bootstrap_, statistic(of_second, rate), statistic(of_first, rate));
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
