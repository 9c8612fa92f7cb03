#include "evaluate/judge.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace etlc::evaluate {

namespace {

using check::kNone;
using etlmon::Verdict;

Label label_of(const Verdict& verdict) {
    if (verdict.satisfied()) return Label::yes;
    return verdict.violated() ? Label::no : Label::unknown;
}

/// The predicate's own comparison, exactly.
bool holds(const check::Predicate& predicate, float delta) {
    const float epsilon = predicate.threshold.value;
    switch (predicate.comparison) {
        case check::Comparison::less_equal: return delta <= epsilon;
        case check::Comparison::less: return delta < epsilon;
        case check::Comparison::greater_equal: return delta >= epsilon;
        case check::Comparison::greater: break;
    }
    return delta > epsilon;
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

/// Per monitor of the plan's model, where it stands in the plan.
std::vector<std::size_t> places(const plan::Plan& plan) {
    std::vector<std::size_t> result(plan.model->monitors.size());
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) result[plan.monitors[m].index] = m;
    return result;
}

bool measures(const plan::Plan& plan, Index predicate) {
    return std::find(plan.predicates.begin(), plan.predicates.end(), predicate) !=
           plan.predicates.end();
}

std::vector<Index> unmeasured(const plan::Plan& plan, std::vector<Index> predicates) {
    std::erase_if(predicates, [&](Index p) { return measures(plan, p); });
    return predicates;
}

}  // namespace

Judge::Judge(const plan::Plan& plan, const plan::Plan& truth, const Subject& subject,
             const calibrate::Leaks& leaks, const data::NamesInFile& names)
    : plan_(plan),
      truth_plan_(truth),
      subject_(subject),
      leaks_(leaks),
      names_(names),
      said_at_(places(plan)),
      truth_at_(places(truth)),
      measuring_(plan::measuring(*plan.model, unmeasured(plan, subject.labelled))),
      monitor_(plan_),
      truth_(truth_plan_),
      measure_(measuring_) {
    std::set<Index> inputs(plan_.inputs.begin(), plan_.inputs.end());
    inputs.insert(measuring_.inputs.begin(), measuring_.inputs.end());
    const std::vector<Index> identity = calibrate::identity_inputs(model());
    inputs.insert(identity.begin(), identity.end());
    wanted_ = {&model(), {inputs.begin(), inputs.end()}, subject.labelled, identity};
    truth_samples_.resize(truth_plan_.model->inputs.size());
}

diag::Result<EpisodeResult> Judge::score(const std::string& path) {
    auto recording =
        calibrate::Recording::open(wanted_, [&](const std::vector<data::Channel>& channels) {
            return data::open_trace(path, data::renamed(channels, names_));
        });
    if (!recording) return recording.failure();
    EpisodeResult result;
    result.path = path;
    result.predicates.resize(subject_.labelled.size());
    result.scored.resize(subject_.labelled.size());
    result.unmeasured.resize(subject_.labelled.size());
    monitor_.reset();
    truth_.reset();
    measure_.reset();
    tracks_.assign(subject_.monitors.size(), {});
    visited_.assign(truth_plan_.monitors.size(), false);
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure();
        if (!*more) break;
        if (!result.leak) result.leak = leaks_.find(recording->samples(), recording->frames() - 1);
        step(*recording, result);
    }
    finish();
    for (std::size_t m = 0; m < subject_.monitors.size(); ++m)
        result.monitors.push_back(conclude(subject_.monitors[m], tracks_[m]));
    for (const Index predicate : subject_.labelled)
        result.from_array.push_back(recording->from_array(predicate));
    result.hash = recording->hash();
    result.content = recording->content();
    result.frames = recording->frames();
    return result;
}

void Judge::step(const calibrate::Recording& recording, EpisodeResult& result) {
    const std::vector<plan::Sample>& samples = recording.samples();
    std::copy(samples.begin(), samples.end(), truth_samples_.begin());
    for (const Index predicate : subject_.labelled)
        truth_samples_[subject_.truth.inputs[predicate]] =
            calibrate::sample_of(recording.label(predicate));
    const std::vector<Verdict>& said = monitor_.step(samples);
    const std::vector<Verdict>& is = truth_.step(truth_samples_);
    measure_.step(samples);
    count_predicates(recording, result);
    note(said, is);
    for (std::size_t m = 0; m < is.size(); ++m) visited_[m] = is[truth_at_[m]].satisfied();
}

float Judge::distance(Index predicate) const {
    return measures(plan_, predicate) ? monitor_.distance(predicate) : measure_.distance(predicate);
}

void Judge::count_predicates(const calibrate::Recording& recording, EpisodeResult& result) const {
    for (std::size_t i = 0; i < subject_.labelled.size(); ++i) {
        const check::Predicate& predicate = model().predicates[subject_.labelled[i]];
        const Label is = recording.label(subject_.labelled[i]);
        const float delta = distance(subject_.labelled[i]);
        if (std::isnan(delta)) {
            result.predicates[i].add(Label::unknown, is);
            result.unmeasured[i] += is == Label::unknown ? 0 : 1;
            continue;
        }
        result.predicates[i].add(holds(predicate, delta) ? Label::yes : Label::no, is);
        if (is == Label::unknown) continue;
        result.scored[i].push_back({predicate.upper_bound() ? -delta : delta, 0, is == Label::yes});
    }
}

/// Both plans delay a sliding monitor alike: by the horizon of its formula as written.
void Judge::note(const std::vector<Verdict>& said, const std::vector<Verdict>& is) {
    for (std::size_t m = 0; m < subject_.monitors.size(); ++m) {
        const MonitorSubject& subject = subject_.monitors[m];
        if (subject.truth == kNone || !said[said_at_[subject.monitor]].decided()) continue;
        tracks_[m].said.push_back(label_of(said[said_at_[subject.monitor]]));
        tracks_[m].is.push_back(label_of(is[truth_at_[subject.truth]]));
    }
}

/// The last positions of the sliding monitors, each as often as it has some left.
void Judge::finish() {
    std::uint32_t longest = 0;
    for (const plan::Monitor& monitor : plan_.monitors)
        longest = std::max(longest, monitor.horizon);
    for (std::uint32_t call = 0; call < longest; ++call) {
        std::vector<Verdict> said = monitor_.finish();
        for (std::size_t m = 0; m < said.size(); ++m)
            if (call >= plan_.monitors[m].horizon) said[m] = Verdict{};
        note(said, truth_.finish());
    }
}

MonitorEpisode Judge::conclude(const MonitorSubject& subject, const Tracks& tracks) const {
    MonitorEpisode result;
    if (tracks.said.empty()) return result;
    for (std::size_t i = 0; i < tracks.said.size(); ++i)
        result.steps.add(tracks.said[i], tracks.is[i]);
    const bool sliding = model().monitors[subject.monitor].sliding;
    const auto verdict = [&](const Track& track) {
        return sliding ? *std::min_element(track.begin(), track.end()) : track.back();
    };
    result.episode.add(verdict(tracks.said), verdict(tracks.is));
    result.turn = turn_of(tracks.said, tracks.is);
    const auto visited = [&](Index stage) { return visited_[stage]; };
    if (!subject.stages.empty() &&
        std::all_of(subject.stages.begin(), subject.stages.end(), visited))
        result.ordering = result.episode;
    return result;
}

}  // namespace etlc::evaluate
