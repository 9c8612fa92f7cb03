#include "evaluate/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "data/files/file.hpp"
#include "episodes/admission.hpp"
#include "episodes/parallel.hpp"

namespace etlc::evaluate {

namespace {

/// At distance 0 a frame is easier to tell than any that is not a target.
void warn_of_leaks(const check::Model& model, const std::vector<EpisodeResult>& episodes,
                   const Request& request, diag::Sink& sink) {
    const auto first = std::find_if(episodes.begin(), episodes.end(),
                                    [](const EpisodeResult& episode) { return episode.leak; });
    if (first == episodes.end()) return;
    const auto leaked = std::count_if(first, episodes.end(),
                                      [](const EpisodeResult& episode) { return episode.leak; });
    auto& warning = sink.report(
        data::in_file({diag::Code::target_in_evaluation, episodes::text(model, *first->leak)},
                      request.episodes[static_cast<std::size_t>(first - episodes.begin())]));
    warning.note(fmt::format("{} of {} {} such a frame: the figures are better than on others",
                             leaked, diag::counted(episodes.size(), "episode"),
                             leaked == 1 ? "has" : "have"));
    warning.note("targets have to come from other recordings");
}

bool has_truth(const MonitorSubject& monitor) {
    return monitor.lacking.empty();
}

bool refuse_without_truth(const check::Model& model, const Subject& subject, diag::Sink& sink) {
    const auto& monitors = subject.monitors;
    if (!subject.labelled.empty() || std::any_of(monitors.begin(), monitors.end(), has_truth))
        return true;
    const std::string name = model.predicates[monitors.front().lacking.front()].name;
    const std::string shown = name.empty() ? "NAME" : name;
    sink.report(diag::Code::nothing_to_evaluate, model.monitors.front().span,
                "no predicate of this spec has a truth to compare it with")
        .note(fmt::format("say when it holds, 'truth {0} = ...;', or record it: an array "
                          "'truth.{0}' of 0 and 1 in the episodes, which --map may name",
                          shown));
    return false;
}

using Get = std::function<Counts(std::size_t episode)>;

Score score(const Bootstrap& bootstrap, const Get& get) {
    std::vector<Counts> each;
    for (std::size_t e = 0; e < bootstrap.whole().size(); ++e) each.push_back(get(e));
    const auto sum = [&](const Weights& weights) {
        Counts counts;
        for (std::size_t e = 0; e < each.size(); ++e) counts.add(each[e], weights[e]);
        return rates(counts);
    };
    const Rates whole = sum(bootstrap.whole());
    std::vector<Rates> resampled;
    for (const Weights& weights : bootstrap.resamples()) resampled.push_back(sum(weights));
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
                 figure(&Rates::agreement)};
    for (const Counts& counts : each) result.counts.add(counts);
    return result;
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

PredicateScore predicate_score(const Bootstrap& bootstrap,
                               const std::vector<EpisodeResult>& episodes, std::size_t i) {
    PredicateScore result;
    result.frames = score(bootstrap, [&](std::size_t e) { return episodes[e].predicates[i]; });
    std::vector<Scored> frames;
    for (std::uint32_t e = 0; e < episodes.size(); ++e) {
        for (Scored frame : episodes[e].scored[i]) {
            frame.episode = e;
            frames.push_back(frame);
        }
        result.unmeasured += episodes[e].unmeasured[i];
        result.arrays += episodes[e].from_array[i] ? 1 : 0;
    }
    // What conformal calibration promises: P(no positive frame of an episode is missed) >= 1 -
    // alpha.
    result.coverage = bootstrap.figure([&](const Weights& weights) -> std::optional<double> {
        std::uint64_t with_positives = 0;
        std::uint64_t covered = 0;
        for (std::size_t e = 0; e < episodes.size(); ++e) {
            const Counts& counts = episodes[e].predicates[i];
            if (counts.positives() == 0) continue;
            with_positives += weights[e];
            covered += counts.true_positives == counts.positives() ? weights[e] : 0;
        }
        if (with_positives == 0) return std::nullopt;
        return static_cast<double>(covered) / static_cast<double>(with_positives);
    });
    const Ranking ranking(std::move(frames));
    result.auroc = bootstrap.figure([&](const Weights& weights) { return ranking.auroc(weights); });
    return result;
}

MonitorScore monitor_score(const Bootstrap& bootstrap, const std::vector<EpisodeResult>& episodes,
                           std::size_t m, const MonitorSubject& subject) {
    MonitorScore result;
    result.steps = score(bootstrap, [&](std::size_t e) { return episodes[e].monitors[m].steps; });
    result.episodes =
        score(bootstrap, [&](std::size_t e) { return episodes[e].monitors[m].episode; });
    result.detection = detection(bootstrap, episodes, m);
    if (!subject.stages.empty())
        result.ordering = score(bootstrap, [&](std::size_t e) {
            return episodes[e].monitors[m].ordering.value_or(Counts{});
        });
    return result;
}

Evaluation summarise(const check::Model& model, const Subject& subject,
                     const std::vector<EpisodeResult>& episodes) {
    Evaluation result;
    result.episodes = episodes.size();
    result.step_seconds = model.step_seconds;
    data::Recordings earlier;
    for (const EpisodeResult& episode : episodes) {
        result.frames += episode.frames;
        const auto overlap = earlier.find(episode.content);
        earlier.add(episode.content);
        result.repeated += overlap && overlap->equal ? 1 : 0;
        result.overlapping += overlap && !overlap->equal ? 1 : 0;
        result.leaked += episode.leak ? 1 : 0;
    }
    const Bootstrap bootstrap(episodes.size());
    for (std::size_t i = 0; i < subject.labelled.size(); ++i) {
        result.predicates.push_back(predicate_score(bootstrap, episodes, i));
        const check::Predicate& predicate = model.predicates[subject.labelled[i]];
        result.predicates.back().name = predicate.name;
        result.predicates.back().adaptive = predicate.threshold.adaptation.has_value();
    }
    for (std::size_t m = 0; m < subject.monitors.size(); ++m) {
        const MonitorSubject& monitor = subject.monitors[m];
        result.monitors.push_back(monitor.lacking.empty()
                                      ? monitor_score(bootstrap, episodes, m, monitor)
                                      : MonitorScore{});
        result.monitors.back().name = model.monitors[monitor.monitor].name;
        for (const Index p : monitor.lacking) {
            result.monitors.back().lacking.push_back(model.predicates[p].shown());
        }
    }
    return result;
}

}  // namespace

std::optional<Evaluation> evaluate(const pipeline::Compiled& spec, const Request& request,
                                   const std::optional<thresholds::File>& seen, diag::Sink& sink) {
    const check::Model& model = *spec.model;
    auto labelled = episodes::labelled_in(model, request.episodes[0], request.names);
    if (!labelled) {
        sink.report(data::in_trace(labelled.failure(), request.episodes[0]));
        return std::nullopt;
    }
    const Subject subject = evaluate::subject(model, std::move(*labelled));
    if (!refuse_without_truth(model, subject, sink)) return std::nullopt;
    const auto truth =
        pipeline::compile(subject.truth.model, {request.limits, check::Values::boolean}, sink);
    if (!truth) return std::nullopt;
    const episodes::Leaks leaks(model, subject.labelled);
    const auto scorer = [&] {
        return std::make_unique<EpisodeScorer>(spec.plan, truth->plan, subject, leaks,
                                               request.names);
    };
    const auto episodes =
        episodes::over_episodes<EpisodeResult>(request.episodes, request, sink, scorer);
    if (!episodes) return std::nullopt;
    thresholds::Allowance allowance;
    if (seen)
        allowance = episodes::admit_unseen(episodes::recorded(*episodes), *seen,
                                           request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;
    warn_of_leaks(model, *episodes, request, sink);
    Evaluation result = summarise(model, subject, *episodes);
    if (seen) result.reservations = model.reservations;
    if (allowance.overlapping > 0) result.reservations.push_back(thresholds::text(allowance));
    return result;
}

}  // namespace etlc::evaluate
