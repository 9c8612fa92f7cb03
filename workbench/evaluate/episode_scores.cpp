#include "evaluate/episode_scores.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "check/formulas/horizons.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "evaluate/evaluate.hpp"
#include "plan/plan.hpp"

namespace etlc::evaluate {

// ---- what is evaluated --------------------------------------------------------------------------

namespace {

using check::Formula;
using Kind = check::Formula::Kind;

bool is_eventually(const Formula& f) {
    return f.kind == Kind::eventually && f.low == 0 && f.high == check::kUnbounded;
}

/// Returns the distinct operands of a conjunction, or the formula itself.
std::vector<Index> conjuncts_of(const check::Model& model, Index formula) {
    std::vector<Index> conjuncts;
    std::vector<bool> seen(model.formulas.size());
    const auto collect = [&](const auto& self, Index at) -> void {
        if (seen[at]) return;
        seen[at] = true;
        const Formula& f = model.formulas[at];
        if (f.kind != Kind::conjunction) return conjuncts.push_back(at);
        for (const Index operand : f.operands) self(self, operand);
    };
    collect(collect, formula);
    return conjuncts;
}

Index append(check::Model& model, Kind kind, std::vector<Index> operands) {
    Formula formula;
    formula.kind = kind;
    formula.operands = std::move(operands);
    model.formulas.push_back(std::move(formula));
    return static_cast<Index>(model.formulas.size() - 1);
}

/// Adds a ground-truth monitor that tells whether the stage has been visited.
Index append_visit(check::Model& model, const std::string& name,
                   const std::vector<Index>& conjuncts) {
    const Index stage =
        conjuncts.size() == 1 ? conjuncts[0] : append(model, Kind::conjunction, conjuncts);
    check::Monitor monitor;
    monitor.name = name;
    monitor.formula = append(model, Kind::eventually, {stage});
    model.monitors.push_back(std::move(monitor));
    return static_cast<Index>(model.monitors.size() - 1);
}

}  // namespace

std::vector<std::vector<Index>> stages_of(const check::Model& model, Index formula) {
    const std::vector<check::Reach> reaches = check::reaches(model);
    std::vector<std::vector<Index>> stages;
    while (is_eventually(model.formulas[formula])) {
        std::vector<Index> conjuncts = conjuncts_of(model, model.formulas[formula].operands[0]);
        const auto in_present = [&](Index c) { return reaches[c].future == check::kNone; };
        const auto rest = std::stable_partition(conjuncts.begin(), conjuncts.end(), in_present);
        const auto further = conjuncts.end() - rest;
        if (further > 1 || (further == 1 && !is_eventually(model.formulas[*rest]))) return {};
        if (rest == conjuncts.begin()) return {};
        stages.emplace_back(conjuncts.begin(), rest);
        if (further == 0) return stages;
        formula = *rest;
    }
    return {};
}

Subject subject(const check::Model& model, std::vector<Index> labelled) {
    Subject result{labelled, {}, episodes::ground_truth(model, labelled), {}};
    check::Model& truth = result.truth.model;
    const auto lacking_in = [&](Index formula) {
        std::vector<Index> lacking;
        for (const Index p : check::predicates_of(model, formula)) {
            const bool has_label = std::find(labelled.begin(), labelled.end(), p) != labelled.end();
            if (!has_label && !check::is_own_truth(model, p)) lacking.push_back(p);
        }
        return lacking;
    };
    for (Index l = 0; l < model.lets.size(); ++l) {
        const check::Let& let = model.lets[l];
        truth.lets[l].telemetry =
            let.telemetry && let.truth != check::kNone && lacking_in(let.truth).empty();
        if (truth.lets[l].telemetry) result.lets.push_back(l);
    }
    const std::vector<check::Monitor> true_monitors = std::exchange(truth.monitors, {});
    for (Index m = 0; m < model.monitors.size(); ++m) {
        const check::Monitor& monitor = model.monitors[m];
        MonitorSubject& subject = result.monitors.emplace_back();
        subject.monitor = m;
        subject.lacking = lacking_in(monitor.true_formula());
        if (!subject.lacking.empty()) continue;
        subject.truth = static_cast<Index>(truth.monitors.size());
        truth.monitors.push_back(true_monitors[m]);
        const auto stages = stages_of(truth, true_monitors[m].formula);
        if (monitor.sliding || stages.size() < 2) continue;
        for (const auto& conjuncts : stages)
            subject.stages.push_back(append_visit(truth, monitor.name, conjuncts));
    }
    return result;
}

bool has_truths(const Subject& subject) {
    return !subject.labelled.empty() ||
           std::any_of(subject.monitors.begin(), subject.monitors.end(),
                       [](const MonitorSubject& monitor) { return monitor.lacking.empty(); });
}

// ---- episode by episode -------------------------------------------------------------------------

namespace {

using check::kNone;
using etlmon::Verdict;

using episodes::label_of;

std::optional<Turn> turn_of(const std::vector<Label>& predicted, const std::vector<Label>& actual) {
    const auto known = [](Label label) { return label != Label::unknown; };
    const auto first = std::find_if(actual.begin(), actual.end(), known);
    if (first == actual.end()) return std::nullopt;
    const auto turned = std::find_if(first, actual.end(),
                                     [&](Label label) { return known(label) && label != *first; });
    if (turned == actual.end()) return std::nullopt;
    const auto onset = turned - actual.begin();
    auto at = onset;
    if (predicted[static_cast<std::size_t>(at)] == *turned) {
        while (at > 0 && predicted[static_cast<std::size_t>(at - 1)] == *turned) --at;
        return Turn{at - onset};
    }
    const auto later = std::find(predicted.begin() + onset, predicted.end(), *turned);
    if (later == predicted.end()) return Turn{};
    return Turn{later - predicted.begin() - onset};
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

/// Scores one episode after the other, on one thread. Its arguments must outlive it.
class EpisodeScorer {
public:
    EpisodeScorer(const plan::Plan& plan, const plan::Plan& truth, const Subject& subject,
                  const episodes::Leaks& leaks, const episodes::ReadOptions& reading,
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
    EpisodeScorer(const EpisodeScorer&) = delete;
    EpisodeScorer& operator=(const EpisodeScorer&) = delete;

    /// Failures do not name the path.
    diag::Result<EpisodeResult> score(const std::string& path) {
        episodes::KeptFrames kept;
        Truths truths(variants_.empty() ? 0 : subject_.labelled.size());
        const auto keep = [&](const episodes::Opener& open) { return kept.keeping(open); };
        auto recording = episodes::Recording::open(
            wanted_, path, reading_, variants_.empty() ? nullptr : episodes::Wrap(keep));
        if (!recording) return recording.failure();
        EpisodeResult result;
        const std::size_t labelled = subject_.labelled.size();
        result.predicates.resize(labelled + subject_.lets.size());
        tracks_.assign(subject_.monitors.size(), {});
        std::vector<MonitorEpisode> alarms(subject_.monitors.size());
        const auto rest = [&] {
            note_alarms(recording->frames() - 1, alarms);
            note_verdicts();
            return true;
        };
        const auto frame = [&] {
            for (std::size_t i = 0; i < labelled; ++i)
                note_frame(*recording, i, result.predicates[i]);
            for (std::size_t i = 0; i < subject_.lets.size(); ++i)
                note_let(i, recording->frames() - 1, result.predicates[labelled + i]);
            for (std::size_t i = 0; i < truths.size(); ++i)
                truths[i].push_back(recording->label(subject_.labelled[i]));
            return rest();
        };
        const auto done =
            episodes::replay(*recording, {&monitors_, &truths_, &measured_}, frame, rest);
        if (!done) return done.failure();
        for (std::size_t m = 0; m < subject_.monitors.size(); ++m) {
            MonitorEpisode& monitor =
                result.monitors.emplace_back(conclude(subject_.monitors[m], tracks_[m]));
            monitor.alarm = alarms[m].alarm;
            monitor.least_upper = alarms[m].least_upper;
        }
        for (std::size_t i = 0; i < labelled; ++i)
            result.predicates[i].from_array = recording->from_array(subject_.labelled[i]);
        static_cast<episodes::Recorded&>(result) = recording->recorded();
        const auto done_too = score_variants(kept, truths, result);
        if (!done_too) return done_too.failure();
        return result;
    }

private:
    using Track = std::vector<Label>;
    using Truths = std::vector<Track>;  ///< per labelled predicate, its label in each frame

    struct Tracks {
        Track predicted;
        Track actual;
        bool predicted_alarm = false;  ///< an alarm at some step
        bool actual_alarm = false;
    };

    /// Runs the monitors and their truths through the variants of an episode that has been read.
    diag::Result<bool> score_variants(const episodes::KeptFrames& kept, const Truths& truths,
                                      EpisodeResult& result) {
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
                    result.monitors[m].variants.back().add(
                        verdict(subject_.monitors[m], tracks_[m]));
            }
        }
        return true;
    }

    float distance(Index predicate) const {
        return measures(plan_, predicate) ? monitors_.evaluator().distance(predicate)
                                          : measured_.evaluator().distance(predicate);
    }

    void note_frame(const episodes::Recording& recording, std::size_t i,
                    PredicateEpisode& result) const {
        const check::Predicate& predicate = model().predicates[subject_.labelled[i]];
        const Label actual = recording.label(subject_.labelled[i]);
        const float delta = distance(subject_.labelled[i]);
        const std::optional<bool> called = predicate.called(delta);
        const Label predicted = !called ? Label::unknown : *called ? Label::yes : Label::no;
        result.frames.add(predicted, actual);
        result.truth.add(actual);
        if (actual == Label::unknown) return;
        if (is_wrong(predicted, actual) && !result.first_error)
            result.first_error = recording.frames() - 1;
        if (std::isnan(delta)) {
            ++result.unmeasured;
            return;
        }
        const float score = predicate.equality()      ? static_cast<float>(*called)
                            : predicate.upper_bound() ? -delta
                                                      : delta;
        result.scored.push_back({score, 0, actual == Label::yes});
    }

    void note_let(std::size_t i, std::uint64_t frame, PredicateEpisode& result) const {
        const Verdict& says = verdict_of(monitors_, subject_.lets[i]);
        const Label predicted = label_of(says);
        const Label actual = label_of(verdict_of(truths_, subject_.lets[i]));
        result.frames.add(predicted, actual);
        result.truth.add(actual);
        if (actual == Label::unknown) return;
        if (is_wrong(predicted, actual) && !result.first_error) result.first_error = frame;
        if (predicted == Label::unknown)
            ++result.unmeasured;
        else
            result.scored.push_back({says.robustness, 0, actual == Label::yes});
    }

    void note_alarms(std::uint64_t step, std::vector<MonitorEpisode>& monitors) const {
        for (std::size_t m = 0; m < monitors.size(); ++m) {
            const Index monitor = subject_.monitors[m].monitor;
            if (!monitors_.reports(monitor)) continue;
            const Verdict& verdict = monitors_.verdict(monitor);
            monitors[m].least_upper = std::min(monitors[m].least_upper, verdict.upper);
            if (verdict.alarm() && !monitors[m].alarm) monitors[m].alarm = step;
        }
    }

    /// Records the verdicts of a step. Both plans delay a sliding monitor by the horizon of its
    /// formula as written.
    void note_verdicts() {
        for (std::size_t m = 0; m < subject_.monitors.size(); ++m) {
            const MonitorSubject& subject = subject_.monitors[m];
            if (subject.truth == kNone || !monitors_.reports(subject.monitor)) continue;
            tracks_[m].predicted.push_back(label_of(monitors_.verdict(subject.monitor)));
            tracks_[m].actual.push_back(label_of(truths_.verdict(subject.truth)));
            if (model().monitors[subject.monitor].restarts == check::Restarts::when_final)
                follow(m);
        }
    }

    /// Restarts the truth of a repeating monitor with it, so that both judge the same positions.
    void follow(std::size_t m) {
        const MonitorSubject& subject = subject_.monitors[m];
        tracks_[m].predicted_alarm |= monitors_.verdict(subject.monitor).alarm();
        tracks_[m].actual_alarm |= truths_.verdict(subject.truth).alarm();
        if (monitors_.verdict(subject.monitor).final()) truths_.restart(subject.truth);
    }

    MonitorEpisode conclude(const MonitorSubject& subject, const Tracks& tracks) const {
        MonitorEpisode result;
        if (tracks.predicted.empty()) return result;
        for (std::size_t i = 0; i < tracks.predicted.size(); ++i) {
            result.steps.add(tracks.predicted[i], tracks.actual[i]);
            result.truth.add(tracks.actual[i]);
            if (is_wrong(tracks.predicted[i], tracks.actual[i]) && !result.first_error)
                result.first_error = i;
        }
        result.episode = verdict(subject, tracks);
        result.turn = turn_of(tracks.predicted, tracks.actual);
        const auto visited = [&](Index stage) { return truths_.verdict(stage).satisfied(); };
        if (!subject.stages.empty() &&
            std::all_of(subject.stages.begin(), subject.stages.end(), visited))
            result.ordering = result.episode;
        return result;
    }

    /// Counts the verdict on the whole episode: the last one, or that a sliding monitor always
    /// holds.
    Counts verdict(const MonitorSubject& subject, const Tracks& tracks) const {
        Counts result;
        if (tracks.predicted.empty()) return result;
        const bool sliding = model().monitors[subject.monitor].sliding;
        const auto of = [&](const Track& track, bool alarm) {
            if (alarm) return Label::no;
            return sliding ? *std::min_element(track.begin(), track.end()) : track.back();
        };
        result.add(of(tracks.predicted, tracks.predicted_alarm),
                   of(tracks.actual, tracks.actual_alarm));
        return result;
    }

    const check::Model& model() const { return *plan_.model; }

    const plan::Plan& plan_;
    const Subject& subject_;
    const episodes::ReadOptions& reading_;
    const std::vector<episodes::Variant>& variants_;
    plan::Plan measuring_;  ///< measures labelled predicates that no monitor uses
    episodes::Follower monitors_;
    episodes::Follower truths_;
    episodes::Follower measured_;
    episodes::Wanted wanted_;
    std::vector<Tracks> tracks_;  ///< per monitor
};

}  // namespace

bool score_episodes(const Trial& trial, const Subject& subject, const Request& request,
                    const std::function<void(std::size_t, EpisodeResult)>& take, diag::Sink& sink) {
    const auto truth = compile(subject.truth.model, {request.limits, check::Values::boolean}, sink);
    if (!truth) return false;
    std::vector<std::string> paths;
    for (const std::size_t e : trial.episodes) paths.push_back(request.episodes[e]);
    const episodes::Leaks leaks(*trial.spec.model, subject.labelled);
    return episodes::over_shared_episodes<EpisodeResult>(
        paths, request, sink,
        [&] {
            return std::make_unique<EpisodeScorer>(trial.spec.plan, truth->plan, subject, leaks,
                                                   request.reading, request.variants);
        },
        take);
}

}  // namespace etlc::evaluate
