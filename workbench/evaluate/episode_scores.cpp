#include "evaluate/episode_scores.hpp"

#include <algorithm>
#include <cmath>

#include "plan/plan.hpp"

namespace etlc::evaluate {

namespace {

using check::kNone;
using etlmon::Verdict;

Label label_of(const Verdict& verdict) {
    if (verdict.satisfied()) return Label::yes;
    return verdict.violated() ? Label::no : Label::unknown;
}

std::optional<Turn> turn_of(const std::vector<Label>& said, const std::vector<Label>& is) {
    const auto known = [](Label label) { return label != Label::unknown; };
    const auto first = std::find_if(is.begin(), is.end(), known);
    if (first == is.end()) return std::nullopt;
    const auto turned =
        std::find_if(first, is.end(), [&](Label label) { return known(label) && label != *first; });
    if (turned == is.end()) return std::nullopt;
    const auto onset = turned - is.begin();
    auto at = onset;
    if (said[static_cast<std::size_t>(at)] == *turned) {
        while (at > 0 && said[static_cast<std::size_t>(at - 1)] == *turned) --at;
        return Turn{at - onset};
    }
    const auto later = std::find(said.begin() + onset, said.end(), *turned);
    if (later == said.end()) return Turn{};
    return Turn{later - said.begin() - onset};
}

bool measures(const plan::Plan& plan, Index predicate) {
    return std::find(plan.predicates.begin(), plan.predicates.end(), predicate) !=
           plan.predicates.end();
}

/// Returns the verdict of a let at the last step.
const Verdict& verdict_of(const episodes::Follower& follower, Index let) {
    const auto& recorded = follower.plan().lets;
    const auto at = std::find_if(recorded.begin(), recorded.end(),
                                 [&](const plan::Let& one) { return one.index == let; });
    return follower.evaluator().lets()[static_cast<std::size_t>(at - recorded.begin())];
}

std::vector<Index> unmeasured(const plan::Plan& plan, std::vector<Index> predicates) {
    std::erase_if(predicates, [&](Index p) { return measures(plan, p); });
    return predicates;
}

}  // namespace

EpisodeScorer::EpisodeScorer(const plan::Plan& plan, const plan::Plan& truth,
                             const Subject& subject, const episodes::Leaks& leaks,
                             const episodes::ReadOptions& reading,
                             const std::vector<episodes::Variant>& variants)
    : plan_(plan),
      subject_(subject),
      reading_(reading),
      variants_(variants),
      measuring_(plan::measuring(*plan.model, unmeasured(plan, subject.labelled))),
      monitors_(plan),
      truths_(truth, &subject.truth),
      measured_(measuring_),
      wanted_(episodes::wanted(model(), {&plan, &measuring_}, subject.labelled, leaks)) {}

diag::Result<EpisodeResult> EpisodeScorer::score(const std::string& path) {
    episodes::KeptFrames kept;
    Truths truths(variants_.empty() ? 0 : subject_.labelled.size());
    const auto keep = [&](const episodes::Opener& open) { return kept.keeping(open); };
    auto recording = episodes::Recording::open(wanted_, path, reading_,
                                               variants_.empty() ? nullptr : episodes::Wrap(keep));
    if (!recording) return recording.failure();
    EpisodeResult result;
    const std::size_t labelled = subject_.labelled.size();
    result.predicates.resize(labelled + subject_.lets.size());
    tracks_.assign(subject_.monitors.size(), {});
    const auto rest = [&] {
        note_verdicts();
        return true;
    };
    const auto frame = [&] {
        for (std::size_t i = 0; i < labelled; ++i) note_frame(*recording, i, result.predicates[i]);
        for (std::size_t i = 0; i < subject_.lets.size(); ++i)
            note_let(i, recording->frames() - 1, result.predicates[labelled + i]);
        for (std::size_t i = 0; i < truths.size(); ++i)
            truths[i].push_back(recording->label(subject_.labelled[i]));
        return rest();
    };
    const auto done = episodes::replay(*recording, {&monitors_, &truths_, &measured_}, frame, rest);
    if (!done) return done.failure();
    for (std::size_t m = 0; m < subject_.monitors.size(); ++m)
        result.monitors.push_back(conclude(subject_.monitors[m], tracks_[m]));
    for (std::size_t i = 0; i < labelled; ++i)
        result.predicates[i].from_array = recording->from_array(subject_.labelled[i]);
    static_cast<episodes::Recorded&>(result) = recording->recorded();
    const auto done_too = score_variants(kept, truths, result);
    if (!done_too) return done_too.failure();
    return result;
}

/// Runs the monitors and their truths through the variants of an episode that has been read.
diag::Result<bool> EpisodeScorer::score_variants(const episodes::KeptFrames& kept,
                                                 const Truths& truths, EpisodeResult& result) {
    episodes::Wanted wanted = wanted_;
    wanted.leaks = nullptr;  // the frames are those of the episode
    for (const episodes::Variant variant : variants_) {
        const auto orders = episodes::orders(variant, truths, result.frames);
        result.variants.push_back(orders.size());
        for (MonitorEpisode& monitor : result.monitors) monitor.variants.emplace_back();
        for (const episodes::Order& order : orders) {
            auto recording = episodes::Recording::open(wanted, kept.in_order(order));
            if (!recording) return recording.failure();
            tracks_.assign(subject_.monitors.size(), {});
            const auto step = [&] {
                note_verdicts();
                return true;
            };
            const auto done = episodes::replay(*recording, {&monitors_, &truths_}, step, step);
            if (!done) return done;
            for (std::size_t m = 0; m < subject_.monitors.size(); ++m)
                result.monitors[m].variants.back().add(verdict(subject_.monitors[m], tracks_[m]));
        }
    }
    return true;
}

float EpisodeScorer::distance(Index predicate) const {
    return measures(plan_, predicate) ? monitors_.evaluator().distance(predicate)
                                      : measured_.evaluator().distance(predicate);
}

void EpisodeScorer::note_frame(const episodes::Recording& recording, std::size_t i,
                               PredicateEpisode& result) const {
    const check::Predicate& predicate = model().predicates[subject_.labelled[i]];
    const Label is = recording.label(subject_.labelled[i]);
    const float delta = distance(subject_.labelled[i]);
    const bool holds = check::holds(predicate.comparison, delta, predicate.threshold.value);
    const Label said = std::isnan(delta) ? Label::unknown : holds ? Label::yes : Label::no;
    result.frames.add(said, is);
    result.truth.add(is);
    if (is == Label::unknown) return;
    if (said != is && !result.first_error) result.first_error = recording.frames() - 1;
    if (said == Label::unknown) {
        ++result.unmeasured;
        return;
    }
    const float score = predicate.equality()      ? static_cast<float>(holds)
                        : predicate.upper_bound() ? -delta
                                                  : delta;
    result.scored.push_back({score, 0, is == Label::yes});
}

void EpisodeScorer::note_let(std::size_t i, std::uint64_t frame, PredicateEpisode& result) const {
    const Verdict& says = verdict_of(monitors_, subject_.lets[i]);
    const Label said = label_of(says);
    const Label is = label_of(verdict_of(truths_, subject_.lets[i]));
    result.frames.add(said, is);
    result.truth.add(is);
    if (is == Label::unknown) return;
    if (said != is && !result.first_error) result.first_error = frame;
    if (said == Label::unknown)
        ++result.unmeasured;
    else
        result.scored.push_back({says.robustness, 0, is == Label::yes});
}

/// Records the verdicts of a step. Both plans delay a sliding monitor by the horizon of its formula
/// as written.
void EpisodeScorer::note_verdicts() {
    for (std::size_t m = 0; m < subject_.monitors.size(); ++m) {
        const MonitorSubject& subject = subject_.monitors[m];
        if (subject.truth == kNone || !monitors_.reports(subject.monitor)) continue;
        tracks_[m].said.push_back(label_of(monitors_.verdict(subject.monitor)));
        tracks_[m].is.push_back(label_of(truths_.verdict(subject.truth)));
        if (model().monitors[subject.monitor].restarts == check::Restarts::when_final) follow(m);
    }
}

/// Restarts the truth of a repeating monitor with it, so that both judge the same positions.
void EpisodeScorer::follow(std::size_t m) {
    const MonitorSubject& subject = subject_.monitors[m];
    tracks_[m].said_alarm |= monitors_.verdict(subject.monitor).alarm();
    tracks_[m].is_alarm |= truths_.verdict(subject.truth).alarm();
    if (monitors_.verdict(subject.monitor).final()) truths_.restart(subject.truth);
}

MonitorEpisode EpisodeScorer::conclude(const MonitorSubject& subject, const Tracks& tracks) const {
    MonitorEpisode result;
    if (tracks.said.empty()) return result;
    for (std::size_t i = 0; i < tracks.said.size(); ++i) {
        result.steps.add(tracks.said[i], tracks.is[i]);
        result.truth.add(tracks.is[i]);
        const bool errs = tracks.is[i] != Label::unknown && tracks.said[i] != tracks.is[i];
        if (errs && !result.first_error) result.first_error = i;
    }
    result.episode = verdict(subject, tracks);
    result.turn = turn_of(tracks.said, tracks.is);
    const auto visited = [&](Index stage) { return truths_.verdict(stage).satisfied(); };
    if (!subject.stages.empty() &&
        std::all_of(subject.stages.begin(), subject.stages.end(), visited))
        result.ordering = result.episode;
    return result;
}

/// Counts the verdict on the whole episode: the last one, or that a sliding monitor always holds.
Counts EpisodeScorer::verdict(const MonitorSubject& subject, const Tracks& tracks) const {
    Counts result;
    if (tracks.said.empty()) return result;
    const bool sliding = model().monitors[subject.monitor].sliding;
    const auto of = [&](const Track& track, bool alarm) {
        if (alarm) return Label::no;
        return sliding ? *std::min_element(track.begin(), track.end()) : track.back();
    };
    result.add(of(tracks.said, tracks.said_alarm), of(tracks.is, tracks.is_alarm));
    return result;
}

}  // namespace etlc::evaluate
