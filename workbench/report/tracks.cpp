#include "report/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etlc::report {

namespace {

using check::kNone;
using episodes::Label;
using etlmon::Verdict;

std::uint32_t code_of_label(Label label) {
    return label == Label::yes ? kYes : label == Label::no ? kNo : kUnknown;
}

Outcome outcome_of(const explain::History& history, bool sliding) {
    Outcome outcome;
    outcome.alarm = history.first_alarm;
    outcome.final_at = sliding ? std::nullopt : history.first_final;
    outcome.robustness = std::numeric_limits<float>::infinity();
    for (std::size_t step = 0; step < history.verdicts.size(); ++step) {
        const Verdict& verdict = history.verdicts[step];
        if (!verdict.decided()) continue;
        const std::uint32_t status = code_of(verdict) % kFinal;
        // Every position of a sliding monitor has a verdict, and a violated one counts.
        const bool worse = sliding && outcome.status == kNo;
        if (!worse) outcome.status = status;
        outcome.robustness =
            sliding ? std::min(outcome.robustness, verdict.robustness) : verdict.robustness;
    }
    return outcome;
}

bool same_numbers(const Numbers& a, const Numbers& b) {
    return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                      [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

bool has_row(const check::Predicate& predicate, const check::Model& model) {
    if (!predicate.plain_distance()) return false;
    const check::Distance& distance = model.distances[predicate.expression.index];
    return distance.aggregation == check::Aggregation::min && !distance.is_between_points();
}

}  // namespace

std::uint32_t code_of(const Verdict& verdict) {
    if (!verdict.decided()) return kUndecided;
    const std::uint32_t status = verdict.satisfied() ? kYes : verdict.violated() ? kNo : kUnknown;
    return status + (verdict.final() ? kFinal : 0);
}

std::vector<std::uint64_t> telling_steps(const Tracks& tracks) {
    std::vector<std::uint64_t> steps;
    for (const Why& why : tracks.reasons) {
        if (why.critical) steps.push_back(why.critical->first);
        steps.push_back(std::min(why.step, tracks.frames - 1));
    }
    for (const Why& why : tracks.reasons)
        for (const Mark& mark : why.samples) steps.insert(steps.end(), {mark.first, mark.last});
    for (const Codes& codes : tracks.codes) {
        if (codes.of == "nearest") continue;
        for (std::size_t step = 1; step < codes.values.size(); ++step)
            if (codes.values[step] != codes.values[step - 1]) steps.push_back(step);
    }
    return steps;
}

TrackReader::TrackReader(const Scene& scene)
    : scene_(scene),
      leaks_(*scene.plan.model, {}),
      program_(ir::lower(*scene.plan.model)),
      monitors_(scene.plan) {
    if (scene.truth != nullptr) truths_.emplace(*scene.truth_plan, &scene.truth->truth);
    for (const plan::Monitor& monitor : scene.plan.monitors) {
        Index of = kNone;
        if (scene.truth != nullptr)
            for (const evaluate::MonitorSubject& subject : scene.truth->monitors)
                if (subject.monitor == monitor.index && subject.lacking.empty()) of = subject.truth;
        truth_of_.push_back(of);
    }
}

episodes::Wanted TrackReader::wanted() const {
    std::vector<const plan::Plan*> plans = {&scene_.plan, &atoms_->plan()};
    std::vector<Index> labelled;
    if (truths_) {
        plans.push_back(scene_.truth_plan);
        labelled = scene_.truth->labelled;
    }
    return episodes::wanted(model(), plans, std::move(labelled), leaks_);
}

void TrackReader::begin(Tracks& tracks) {
    observations_ = std::make_unique<explain::Observations>(model(), scene_.plan.values,
                                                            scene_.predicates, scene_.plan.inputs);
    atoms_.emplace(observations_->plan());
    said_.assign(scene_.plan.monitors.size(), {});
    if (truths_)
        for (std::size_t i = 0; i < scene_.predicates.size(); ++i)
            if (std::binary_search(scene_.truth->labelled.begin(), scene_.truth->labelled.end(),
                                   scene_.predicates[i]))
                tracks.codes.push_back({"truth", i, {}});
    for (std::size_t k = 0; k < scene_.planes.size(); ++k) {
        tracks.numbers.push_back({"x", k, {}});
        tracks.numbers.push_back({"y", k, {}});
    }
}

diag::Result<Tracks> TrackReader::score(const std::string& path) {
    Tracks tracks;
    tracks.path = path;
    begin(tracks);
    auto recording = episodes::Recording::open(wanted(), path, scene_.reading);
    if (!recording) return recording.failure();
    std::vector<episodes::Follower*> followers = {&monitors_, &*atoms_};
    if (truths_) followers.push_back(&*truths_);
    const auto frame = [&] {
        note_frame(*recording, tracks);
        return true;
    };
    const auto rest = [&] {
        for (std::size_t m = 0; m < said_.size(); ++m)
            if (monitors_.reports(scene_.plan.monitors[m].index))
                said_[m].history.add_after_trace(monitors_.verdicts()[m],
                                                 monitors_.evaluator().position(m));
        return true;
    };
    const auto done = episodes::replay(*recording, followers, frame, rest);
    if (!done) return done.failure();
    tracks.frames = recording->frames();
    if (tracks.frames == 0) return recordings::no_steps();
    for (const Index input : scene_.plan.inputs)
        tracks.sample_counts.push_back(monitors_.evaluator().sample_counts()[input]);
    add_measurements(tracks);
    add_verdicts(tracks);
    add_reasons(tracks);
    return tracks;
}

void TrackReader::note_frame(const episodes::Recording& recording, Tracks& tracks) {
    observations_->add(atoms_->evaluator());
    for (std::size_t m = 0; m < said_.size(); ++m) {
        said_[m].history.add(monitors_.verdicts()[m], monitors_.evaluator().position(m));
        if (truth_of_[m] != kNone) note_truth(m);
    }
    for (Codes& track : tracks.codes)
        track.values.push_back(code_of_label(recording.label(scene_.predicates[track.index])));
    for (Numbers& track : tracks.numbers) {
        const Plane& plane = scene_.planes[track.index];
        const float* z = atoms_->evaluator().point(plane.point);
        track.values.push_back(z == nullptr ? std::numeric_limits<float>::quiet_NaN()
                                            : plane(z)[track.of == "x" ? 0 : 1]);
    }
}

/// Records a true verdict, and restarts the truth of a repeating monitor with it.
void TrackReader::note_truth(std::size_t monitor) {
    const plan::Monitor& of = scene_.plan.monitors[monitor];
    const Verdict& is = truths_->verdict(truth_of_[monitor]);
    said_[monitor].truth.push_back(code_of(is) % kFinal);
    if (of.restarts == check::Restarts::when_final && monitors_.verdicts()[monitor].final())
        truths_->restart(truth_of_[monitor]);
}

void TrackReader::add_measurements(Tracks& tracks) const {
    const std::uint64_t steps = observations_->steps();
    for (std::size_t i = 0; i < scene_.predicates.size(); ++i) {
        const Index atom = observations_->atom(true, scene_.predicates[i]);
        Numbers distance{"distance", i, {}};
        Codes holds{"holds", i, {}};
        Codes nearest{"nearest", i, {}};
        const check::Predicate& predicate = model().predicates[scene_.predicates[i]];
        for (std::uint64_t step = 0; step < steps; ++step) {
            const float delta = observations_->measured({atom, step});
            const bool is_so = check::holds(predicate.comparison, delta, predicate.threshold.value);
            distance.values.push_back(delta);
            holds.values.push_back(std::isnan(delta) ? kUnknown : is_so ? kYes : kNo);
        }
        if (has_row(predicate, model()))
            for (std::uint64_t step = 0; step < steps; ++step)
                nearest.values.push_back(observations_->nearest({atom, step}, 0));
        tracks.numbers.push_back(std::move(distance));
        tracks.codes.push_back(std::move(holds));
        if (!nearest.values.empty()) tracks.codes.push_back(std::move(nearest));
    }
    for (std::size_t i = 0; i < scene_.plan.inputs.size(); ++i) {
        const Index input = scene_.plan.inputs[i];
        if (model().inputs[input].type != check::InputType::boolean) continue;
        Codes flags{"input", i, {}};
        for (std::uint64_t step = 0; step < steps; ++step) {
            const float flag = observations_->measured({observations_->atom(false, input), step});
            flags.values.push_back(std::isnan(flag) ? kUnknown : flag != 0 ? kYes : kNo);
        }
        tracks.codes.push_back(std::move(flags));
    }
}

void TrackReader::add_verdicts(Tracks& tracks) const {
    for (std::size_t m = 0; m < said_.size(); ++m) {
        const explain::History& history = said_[m].history;
        tracks.outcomes.push_back(outcome_of(history, scene_.plan.monitors[m].sliding));
        Numbers robustness{"robustness", m, {}};
        Numbers lower{"lower", m, {}};
        Numbers upper{"upper", m, {}};
        Codes status{"status", m, {}};
        for (std::uint64_t step = 0; step < tracks.frames; ++step) {
            const Verdict& verdict = history.verdicts[step];
            robustness.values.push_back(verdict.robustness);
            lower.values.push_back(verdict.lower);
            upper.values.push_back(verdict.upper);
            status.values.push_back(code_of(verdict));
        }
        // A bound that equals the robustness is left out and drawn from it, as always for a sliding
        // monitor.
        for (Numbers* bound : {&lower, &upper})
            if (!scene_.plan.monitors[m].sliding && !same_numbers(*bound, robustness))
                tracks.numbers.push_back(std::move(*bound));
        tracks.numbers.push_back(std::move(robustness));
        tracks.codes.push_back(std::move(status));
        if (!said_[m].truth.empty()) tracks.codes.push_back({"monitor_truth", m, said_[m].truth});
    }
}

Mark TrackReader::mark(explain::Sample sample, std::uint64_t last, bool holds) const {
    const explain::Atom& atom = observations_->atoms()[sample.atom];
    const std::vector<Index>& all = atom.is_predicate ? scene_.predicates : scene_.plan.inputs;
    const auto at = std::find(all.begin(), all.end(), atom.index);
    return {atom.is_predicate, static_cast<std::size_t>(at - all.begin()), sample.step, last,
            holds};
}

void TrackReader::add_reasons(Tracks& tracks) const {
    for (std::size_t m = 0; m < said_.size(); ++m) {
        const plan::Monitor& monitor = scene_.plan.monitors[m];
        const explain::History& history = said_[m].history;
        const std::uint64_t step = history.usual_step(monitor.sliding, tracks.frames - 1);
        const Verdict& verdict = history.verdicts[step];
        if (!verdict.decided()) continue;
        const explain::Question question{monitor.index, history.positions[step], step};
        const explain::Report report{*observations_, question, verdict.final(),
                                     explain::explain(program_, *observations_, question)};
        const explain::Explanation& found = report.explanation;
        Why why{m,  step, question.position, explain::word(found.status), found.for_good, "",
                {}, {}};
        why.text = explain::text(report);
        for (const explain::Interval& i : explain::intervals(*observations_, found.samples))
            why.samples.push_back(mark({i.atom, i.first}, i.last, i.holds));
        if (found.critical) {
            const explain::Sample at = *found.critical;
            why.critical = mark(at, at.step, observations_->value(at).low >= 0);
        }
        tracks.reasons.push_back(std::move(why));
    }
}

}  // namespace etlc::report
