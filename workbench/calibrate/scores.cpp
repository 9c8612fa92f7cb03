#include "calibrate/scores.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "calibrate/bounds.hpp"
#include "calibrate/calibrate.hpp"
#include "plan/plan.hpp"

namespace etlc::calibrate {

using check::ThresholdOrigin;
using episodes::Label;

void SideScores::add(double reach, bool keep) {
    worst_reach = has_score ? std::max(worst_reach, reach) : reach;
    has_score = true;
    if (keep) reaches.push_back(reach);
}

void SideScores::add_normal(double reach, double measured) {
    worst_measured = has_score ? std::max(worst_measured, measured) : measured;
    add(reach, false);
}

void Evidence::Side::add(const SideScores& scores, std::uint32_t group) {
    constexpr std::uint32_t kNowhere = UINT32_MAX;
    if (group >= places.size()) places.resize(group + std::size_t{1}, kNowhere);
    frames += scores.frames;
    without_score += scores.has_score ? 0 : 1;
    if (scores.has_score && places[group] == kNowhere) {
        places[group] = static_cast<std::uint32_t>(worst.size());
        worst.push_back({scores.worst_reach, group});
        measured.push_back(scores.worst_measured);
    } else if (scores.has_score) {
        Reach& known = worst[places[group]];
        known.reach = std::max(known.reach, scores.worst_reach);
        double& here = measured[places[group]];
        here = std::max(here, scores.worst_measured);
    }
    const auto episode = static_cast<std::uint32_t>(episodes.size());
    if (scores.frames > 0) episodes.push_back({group, scores.frames, scores.lost});
    for (const double reach : scores.reaches) reaches.add({reach, group, episode});
}

void Evidence::add(const Scores& scores, std::uint32_t group) {
    groups = std::max(groups, group + 1);
    ++demonstrations;
    from_array += scores.from_array ? 1 : 0;
    unlabelled += scores.unlabelled;
    unmeasured += scores.unmeasured;
    positives.add(scores.positives, group);
    negatives.add(scores.negatives, group);
    for (const Scores::Labelled& frame : scores.labelled)
        labelled.add({frame.score, group, frame.positive});
}

std::vector<double> measured_scores(const Evidence& evidence, bool above) {
    std::vector<double> scores = evidence.positives.measured;
    for (double& score : scores) score = above ? score : 0.0 - score;
    std::sort(scores.begin(), scores.end());
    return scores;
}

bool is_against(const check::Threshold& threshold, bool misses) {
    const bool one = threshold.against == check::Against::misses ||
                     threshold.against == check::Against::missed_success;
    return threshold.against == check::Against::both || one == misses;
}

bool keeps_all(const check::Threshold& threshold) {
    return threshold.origin == ThresholdOrigin::class_conditional ||
           threshold.origin == ThresholdOrigin::risk;
}

std::vector<Index> calibrated_predicates(const check::Model& model) {
    std::vector<Index> found;
    for (Index i = 0; i < model.predicates.size(); ++i)
        if (model.predicates[i].threshold.origin != ThresholdOrigin::literal) found.push_back(i);
    return found;
}

bool is_normal(const check::Threshold& threshold) {
    return threshold.origin == ThresholdOrigin::normal;
}

bool leaves_out(const check::Threshold& threshold, const episodes::Recorded& episode) {
    return is_normal(threshold) && !episode.outcome.is_demonstration();
}

std::vector<Index> with_labels(const check::Model& model, std::vector<Index> predicates) {
    std::erase_if(predicates, [&](Index p) { return is_normal(model.predicates[p].threshold); });
    return predicates;
}

namespace {

/// Returns the elements of both, ascending.
std::vector<Index> all_of(std::vector<Index> some, const std::vector<Index>& others) {
    some.insert(some.end(), others.begin(), others.end());
    std::sort(some.begin(), some.end());
    some.erase(std::unique(some.begin(), some.end()), some.end());
    return some;
}

/// Scores one demonstration after the other, on one thread. Inputs that only the watched predicates
/// and flags read may be absent, and labels that only divide episodes. The arguments outlive it.
class Scorer {
public:
    Scorer(const check::Model& model, const episodes::Leaks& leaks,
           const std::vector<Index>& predicates, const Watched& watched,
           const episodes::ReadOptions& reading)
        : model_(model),
          predicates_(predicates),
          watched_(watched),
          plan_(plan::measuring(model, all_of(predicates_, watched_.predicates))),
          measured_(plan_),
          pasts_(model, plan_),
          reading_(reading) {
        const plan::Plan calibrated = plan::measuring(model, predicates_);
        const std::vector<Index> labelled = with_labels(model, predicates_);
        wanted_ = episodes::wanted(model, {&calibrated}, labelled, leaks);
        wanted_.optional = all_of(plan_.inputs, watched_.flags);
        std::erase_if(wanted_.optional, [&](Index input) {
            return std::find(wanted_.inputs.begin(), wanted_.inputs.end(), input) !=
                   wanted_.inputs.end();
        });
        wanted_.within.resize(model.predicates.size());
        for (const Index p : predicates_) wanted_.within[p] = model.predicates[p].threshold.within;
        divided_ = wanted_;
        divided_.predicates = all_of(labelled, watched_.dividing);
    }
    Scorer(const Scorer&) = delete;
    Scorer& operator=(const Scorer&) = delete;

    /// Failures do not name the path.
    diag::Result<Demonstration> score(const std::string& path) {
        auto divided = score(path, divided_);
        if (divided || divided_.predicates.size() == wanted_.predicates.size()) return divided;
        return score(path, wanted_);
    }

private:
    diag::Result<Demonstration> score(const std::string& path, const episodes::Wanted& wanted) {
        auto recording = episodes::Recording::open(wanted, path, reading_);
        if (!recording) return recording.failure();
        std::vector<Scores> scores(predicates_.size());
        std::string track;
        const bool is_divided = wanted.predicates.size() == divided_.predicates.size();
        pasts_.reset();
        const auto done = episodes::replay(*recording, {&measured_}, [&] {
            pasts_.step(measured_.evaluator());
            for (std::size_t i = 0; i < predicates_.size(); ++i) {
                const Index p = predicates_[i];
                add(p, is_normal(model_.predicates[p].threshold) ? Label::yes : recording->label(p),
                    scores[i]);
            }
            add_step(watched_, measured_.evaluator(), *recording, is_divided, track);
            return true;
        });
        if (!done) return done.failure();
        for (std::size_t i = 0; i < predicates_.size(); ++i) {
            const Index p = predicates_[i];
            scores[i].from_array =
                !is_normal(model_.predicates[p].threshold) && recording->from_array(p);
            scores[i].labelled.shrink_to_fit();  // they are kept for all episodes
        }
        return Demonstration{recording->recorded(), std::move(scores), std::move(track),
                             recording->is_complete(), is_divided};
    }

    void add(Index predicate, Label label, Scores& scores) const {
        if (label == Label::unknown) {
            ++scores.unlabelled;
            return;
        }
        const bool positive = label == Label::yes;
        const check::Predicate& p = model_.predicates[predicate];
        SideScores& side = scores.side(positive);
        ++side.frames;
        const float delta = measured_.evaluator().distance(predicate);
        if (std::isnan(delta)) {
            ++scores.unmeasured;
            side.lost += p.missing && *p.missing != positive ? 1 : 0;
            return;
        }
        const float score = p.upper_bound() ? delta : -delta;
        scores.labelled.push_back({score, positive});
        if (!is_against(p.threshold, positive) || p.threshold.origin == ThresholdOrigin::f1) return;
        const Interval interval = *interval_of(model_, predicate, measured_.evaluator(), pasts_);
        const double reach = p.upper_bound() == positive ? interval.high : -interval.low;
        if (is_normal(p.threshold)) return side.add_normal(reach, static_cast<double>(score));
        side.add(reach, keeps_all(p.threshold));
    }

    const check::Model& model_;
    const std::vector<Index>& predicates_;
    const Watched& watched_;
    plan::Plan plan_;
    episodes::Follower measured_;
    PastIntervals pasts_;
    episodes::Wanted wanted_;
    episodes::Wanted divided_;  ///< the same with the labels that divide episodes
    const episodes::ReadOptions& reading_;
};

}  // namespace

bool score_demonstrations(const check::Model& model, const std::vector<Index>& predicates,
                          const Watched& watched, const Request& request,
                          const std::function<void(const Demonstration&)>& take, diag::Sink& sink) {
    const episodes::Leaks leaks(model, predicates);
    return episodes::over_shared_episodes<Demonstration>(
        request.episodes, request, sink,
        [&] {
            return std::make_unique<Scorer>(model, leaks, predicates, watched, request.reading);
        },
        [&](std::size_t, const Demonstration& demonstration) { take(demonstration); });
}

}  // namespace etlc::calibrate
