#include "evaluate/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/files/file.hpp"
#include "episodes/admission/admission.hpp"

namespace etlc::evaluate {

namespace {

/// Warns about episodes with a target among their frames: at distance 0 a frame is easier to tell
/// than any other.
void warn_of_leaks(const check::Model& model, const Judgement& judgement, const Request& request,
                   diag::Sink& sink) {
    const episodes::LeakEvidence evidence(judgement.episodes);
    std::optional<std::size_t> first;
    std::optional<episodes::Leak> leak;
    std::uint64_t leaked = 0;
    judgement.for_each(judgement.episodes, [&](std::size_t e, const episodes::Recorded& episode) {
        const auto found = evidence.of(episode);
        if (!found) return;
        if (!first) leak = found;
        if (!first) first = e;
        ++leaked;
    });
    if (!first) return;
    auto& warning =
        sink.report(data::in_file({diag::Code::target_in_evaluation, episodes::text(model, *leak)},
                                  request.episodes[*first]));
    warning.note(fmt::format("{} of {} {} such a frame: the figures are better than on others",
                             leaked, diag::counted(judgement.place.size(), "episode"),
                             leaked == 1 ? "has" : "have"));
    warning.note("targets have to come from other recordings");
}

bool refuse_without_truth(const check::Model& model, const Subject& subject, bool has_outcomes,
                          diag::Sink& sink) {
    if (has_truths(subject) || has_outcomes) return true;
    const std::string name = model.predicates[subject.monitors.front().lacking.front()].name;
    const std::string shown = name.empty() ? "NAME" : name;
    sink.report(diag::Code::nothing_to_evaluate, model.monitors.front().span,
                "no predicate of this spec has a truth to compare it with")
        .note(fmt::format("add 'truth {0} = ...;' to the spec, or record an array "
                          "'truth.{0}' of 0 and 1 in the episodes, which --map may name, or label "
                          "them in a table labels.csv, which may also say which episodes succeed",
                          shown));
    return false;
}

std::vector<std::pair<std::string, float>> calibrated_in(const check::Model& model) {
    std::vector<std::pair<std::string, float>> thresholds;
    const auto add = [&](const std::string& name, const check::Threshold& of) {
        thresholds.emplace_back(name, of.value);
        // One fold may have one threshold, halfway, where another has two.
        if (of.against == check::Against::both) thresholds.emplace_back(name + ", inner", of.low());
    };
    for (const check::Predicate& predicate : model.predicates)
        if (predicate.threshold.origin != check::ThresholdOrigin::literal)
            add(predicate.name, predicate.threshold);
    for (const check::Monitor& monitor : model.monitors) {
        if (monitor.calibration) add(monitor.name, *monitor.calibration);
        if (monitor.duration)
            thresholds.emplace_back(monitor.name + ", steps",
                                    static_cast<float>(monitor.duration->steps));
    }
    return thresholds;
}

/// Returns a judgement without episodes that names the predicates and monitors.
Judgement judgement_of(const check::Model& model, const Subject& subject, std::size_t episodes,
                       std::size_t folds) {
    Judgement result;
    result.step_seconds = model.step_seconds;
    result.place.resize(episodes);
    result.fold_of.resize(episodes);
    for (const Index p : subject.labelled) {
        auto& named = result.predicates.emplace_back();
        named.name = model.predicates[p].name;
        named.adaptive = model.predicates[p].threshold.adaptation.has_value();
        named.frames.resize(folds);
    }
    for (const Index let : subject.lets) {
        auto& named = result.predicates.emplace_back();
        named.name = model.lets[let].name;
        named.frames.resize(folds);
    }
    for (const MonitorSubject& monitor : subject.monitors) {
        auto& named = result.monitors.emplace_back();
        named.name = model.monitors[monitor.monitor].name;
        named.sequential = !monitor.stages.empty();
        for (const Index p : monitor.lacking) named.lacking.push_back(model.predicates[p].shown());
    }
    return result;
}

/// Adds the result of an episode of the request.
void add(EpisodeResult result, std::size_t episode, std::size_t fold, Judgement& judgement) {
    judgement.place[episode] = static_cast<std::uint32_t>(judgement.episodes.size());
    judgement.fold_of[episode] = static_cast<std::uint32_t>(fold);
    judgement.episodes.add(result);
    for (std::size_t i = 0; i < judgement.predicates.size(); ++i) {
        Judgement::Predicate& predicate = judgement.predicates[i];
        for (episodes::Scored frame : std::exchange(result.predicates[i].scored, {})) {
            frame.episode = static_cast<std::uint32_t>(episode);
            predicate.frames[fold].add(frame);
        }
        predicate.episodes.add(result.predicates[i]);
    }
    for (std::size_t m = 0; m < judgement.monitors.size(); ++m)
        judgement.monitors[m].episodes.add(result.monitors[m]);
    for (std::size_t v = 0; v < judgement.variants.size(); ++v) {
        judgement.variants[v].made += result.variants[v];
        judgement.variants[v].left_out += result.variants[v] == 0 ? 1 : 0;
    }
}

/// Fewer episodes give no reliable interval.
constexpr std::uint64_t kFewEpisodes = 5;

/// Warns where both labels occur, and nearly no resample is better than saying true at every frame,
/// or all are worse than a rule that looks at the number of the frame alone. Only predicates: a
/// monitor that must not miss an alarm raises many on purpose. So does a predicate whose threshold
/// has a guarantee, where time is the better judge of F1 only. F1 says little where a predicate
/// with two thresholds leaves frames unknown.
void warn_of_no_gain(const check::Predicate& predicate, const Score& score, diag::Sink& sink) {
    using enum check::ThresholdOrigin;
    const std::string& name = predicate.name;
    const source::Span span = predicate.threshold.span;
    const bool for_f1 = predicate.threshold.origin == literal || predicate.threshold.origin == f1;
    const bool both = score.counts.positives() > 0 && score.counts.negatives() > 0;
    if (!both || !score.f1.interval || predicate.threshold.inner) return;
    const auto warn = [&](double other, const std::string& of) -> diag::Diagnostic& {
        return episodes::warn_of_data(
            diag::Code::no_better_than_true,
            fmt::format("'{}' has an F1 of {:.3f}, no better than the {:.3f} of {}", name,
                        *score.f1.value, other, of),
            span, sink);
    };
    const double clock = score.duration ? rates(*score.duration).f1.value_or(0) : 0;
    if (score.gain.interval && score.gain.interval->high <= 0)
        warn(*score.f1.value - *score.gain.value, "saying true at every frame")
            .note("check the threshold, which may be too wide, the targets and the labels");
    else if (for_f1 && score.f1.interval->high < clock)
        warn(clock, "a rule over the number of the frame alone")
            .note(
                "time tells more than the distance: try formulas over time (etlc fit --suggest), "
                "and episodes whose timing differs");
}

}  // namespace

std::optional<Judgement> judge(const std::vector<Trial>& trials, const Request& request,
                               diag::Sink& sink) {
    const check::Model& first = *trials[0].spec.model;
    const auto labelled = episodes::labelled_in_first(first, request, sink);
    if (!labelled) return std::nullopt;
    Judgement result =
        judgement_of(first, subject(first, *labelled), request.episodes.size(), trials.size());
    result.only_trained = request.only_trained;
    for (const episodes::Variant variant : request.variants)
        result.variants.push_back({variant, 0, 0});
    const bool may_have_outcomes =
        (request.reading.labels && request.reading.labels->has_outcomes()) ||
        (request.sharing != nullptr && request.sharing->merges());
    if (!refuse_without_truth(first, subject(first, *labelled), may_have_outcomes, sink))
        return std::nullopt;
    for (std::size_t t = 0; t < trials.size(); ++t) {
        const Trial& trial = trials[t];
        const check::Model& model = *trial.spec.model;
        const bool has_seen = trial.seen || !trial.fitted.episodes.empty();
        episodes::Identities own;
        const auto take = [&](std::size_t i, EpisodeResult episode) {
            if (has_seen) own.add(episode);
            add(std::move(episode), trial.episodes[i], t, result);
        };
        if (!score_episodes(trial, subject(model, *labelled), request, take, sink))
            return std::nullopt;
        thresholds::Allowance allowance;
        if (has_seen)
            allowance = episodes::admit_unseen(own, trial.seen.value_or(thresholds::File{}),
                                               trial.fitted, request.allow_overlap, sink);
        if (trials.size() > 1 || request.only_trained > 0) {
            result.folds.push_back({trial.episodes.size(), calibrated_in(model)});
        } else {
            if (has_seen) result.reservations = model.reservations;
            if (allowance.overlapping > 0)
                result.reservations.push_back(thresholds::text(allowance));
        }
    }
    if (sink.has_errors()) return std::nullopt;
    bool has_outcomes = false;
    result.for_each(result.episodes, [&](std::size_t, const episodes::Recorded& episode) {
        result.groups.add(episode.group);
        has_outcomes |= episode.outcome.kind != episodes::Outcome::Kind::none;
    });
    if (!refuse_without_truth(first, subject(first, *labelled), has_outcomes, sink))
        return std::nullopt;
    episodes::warn_of_unmarked(result.episodes, sink);
    warn_of_leaks(first, result, request, sink);
    return result;
}

void warn_of_doubts(const check::Model& model, const Evaluation& evaluation, diag::Sink& sink) {
    const bool enough = evaluation.groups.value_or(evaluation.episodes) >= kFewEpisodes;
    for (const PredicateScore& score : evaluation.predicates) {
        const auto predicate =
            std::find_if(model.predicates.begin(), model.predicates.end(),
                         [&](const check::Predicate& one) { return one.name == score.name; });
        if (predicate == model.predicates.end()) continue;
        const Counts& counts = score.frames.counts;
        if (!episodes::warn_of_labels(*predicate, {counts.positives(), counts.negatives()},
                                      enough ? score.auroc : Figure{}, sink) &&
            enough)
            warn_of_no_gain(*predicate, score.frames, sink);
    }
}

}  // namespace etlc::evaluate
