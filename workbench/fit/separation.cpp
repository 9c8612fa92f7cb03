#include "fit/separation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <memory>
#include <set>

#include "episodes/parallel.hpp"
#include "episodes/recording.hpp"
#include "plan/plan.hpp"
#include "plan/targets/kernels.hpp"

namespace etlc::fit {

namespace {

/// Returns the refusal of the first refused projection of the point.
const Refusal* refusal_of(const check::Model& model, Index point,
                          const std::map<Index, Refusal>& refusals) {
    for (; model.points[point].is_projected(); point = model.points[point].inner) {
        const auto found = refusals.find(model.projections[model.points[point].projection].fitted);
        if (found != refusals.end()) return &found->second;
    }
    return nullptr;
}

}  // namespace

Filled fill(const check::Model& model, Solver& solver, std::optional<std::size_t> left_out) {
    Filled result{model, std::vector<Solution>(model.fitted.size()), {}};
    for (Index i = 0; i < model.fitted.size(); ++i) {
        if (const Refusal* of_point = refusal_of(model, model.fitted[i].point, result.refusals)) {
            result.refusals[i] = *of_point;
            continue;
        }
        auto outcome = solver.solve(result.model, i, left_out);
        if (auto* refusal = std::get_if<Refusal>(&outcome)) {
            result.refusals[i] = std::move(*refusal);
            continue;
        }
        result.solutions[i] = std::move(std::get<Solution>(outcome));
        if (const auto target = check::fill(result.model, i, result.solutions[i].filling))
            result.refusals[i] = {diag::Code::fit_out_of_range,
                                  fmt::format("with it, a row of target '{}' is beyond float32",
                                              model.targets[*target].name)};
    }
    return result;
}

FilledAll fill_all(const check::Model& model, Solver& solver, bool all, bool without,
                   unsigned jobs) {
    const std::size_t folds = without ? solver.collection().folds.size() : 0;
    solver.prepare(model, jobs);
    FilledAll result{{}, std::vector<Filled>(folds)};
    std::atomic<std::size_t> next = all ? 0 : 1;
    const std::exception_ptr failure = episodes::in_threads(jobs, folds + 1, [&] {
        for (std::size_t i = next++; i <= folds; i = next++)
            if (i == 0)
                result.all = fill(model, solver, std::nullopt);
            else
                result.without[i - 1] = fill(model, solver, i - 1);
    });
    if (failure) std::rethrow_exception(failure);
    return result;
}

namespace {

using check::kNone;
using episodes::Label;
using episodes::RankedFrame;

/// The model and plan that measure one fold.
struct Fold {
    const check::Model& model;
    plan::Plan plan;
    std::vector<std::optional<Vector>> means;  ///< per predicate, for the plain distance
};

/// The two scores of a predicate in an episode.
struct Ranked {
    std::vector<RankedFrame> before;
    std::vector<RankedFrame> after;
};
using Episode = std::vector<Ranked>;  ///< per predicate

std::optional<Vector> mean_of(const Needs& needs, const std::optional<Need>& need,
                              const Collection& collection, std::size_t left_out) {
    if (!need) return std::nullopt;
    const auto found = std::find(needs.all.begin(), needs.all.end(), *need);
    if (found == needs.all.end()) return std::nullopt;
    const auto at = static_cast<std::size_t>(found - needs.all.begin());
    Moments all;
    for (std::size_t f = 0; f < collection.folds.size(); ++f) {
        if (f == left_out) continue;
        const Moments& fold = collection.folds[f][at].moments;
        if (all.dimension() == 0)
            all = fold;
        else
            all.merge(fold);
    }
    if (all.frames(1) == 0) return std::nullopt;
    return all.mean(1);
}

/// Measures an episode with what was fitted without its fold.
class Measurer {
public:
    Measurer(const check::Model& model, const std::vector<std::unique_ptr<Fold>>& folds,
             const Collection& collection, const std::vector<Measured>& predicates)
        : folds_(folds),
          collection_(collection),
          predicates_(predicates),
          plain_(plain_needs(model, predicates)),
          recent_(model, points_of(plain_)) {
        for (const auto& fold : folds)
            followers_.push_back(std::make_unique<episodes::Follower>(fold->plan));
    }

    diag::Result<Episode> score(const std::string& path) {
        const std::size_t episode = collection_.recordings.index_of(path);
        const std::size_t at = collection_.fold_of(episode);
        auto frames = collection_.recordings.open(episode);
        if (!frames) return frames.failure();
        Episode result(predicates_.size());
        recent_.reset();
        const auto done = episodes::replay(*frames, {followers_[at].get()}, [&] {
            recent_.push(frames->samples());
            for (std::size_t i = 0; i < predicates_.size(); ++i)
                add(*folds_[at], *followers_[at], *frames, episode, i, result[i]);
            return true;
        });
        if (!done) return done.failure();
        return result;
    }

private:
    static std::vector<std::optional<Need>> plain_needs(const check::Model& model,
                                                        const std::vector<Measured>& predicates) {
        std::vector<std::optional<Need>> result;
        for (const Measured& one : predicates) result.push_back(plain_need(model, one.predicate));
        return result;
    }

    static std::vector<Index> points_of(const std::vector<std::optional<Need>>& needs) {
        std::vector<Index> points;
        for (const auto& need : needs)
            if (need) points.push_back(need->point);
        return points;
    }

    void add(const Fold& fold, const episodes::Follower& follower, const episodes::Frames& frames,
             std::size_t episode, std::size_t i, Ranked& ranked) {
        const Label label = frames.label(predicates_[i].label);
        if (label == Label::unknown) return;
        const bool positive = label == Label::yes;
        const auto number = static_cast<std::uint32_t>(episode);
        const std::size_t step = frames.frames() - 1;
        const float delta = follower.evaluator().distance(predicates_[i].predicate);
        const bool upper = fold.model.predicates[predicates_[i].predicate].upper_bound();
        if (!std::isnan(delta))
            ranked.after.push_back({{upper ? -delta : delta, number, positive}, step});
        if (!plain_[i] || !fold.means[i] || !recent_.read(plain_[i]->point, point_)) return;
        const double squared = squared_distance(point_, *fold.means[i]);
        ranked.before.push_back({{-static_cast<float>(squared), number, positive}, step});
    }

    const std::vector<std::unique_ptr<Fold>>& folds_;
    const Collection& collection_;
    const std::vector<Measured>& predicates_;
    std::vector<std::unique_ptr<episodes::Follower>> followers_;  ///< per fold
    std::vector<std::optional<Need>> plain_;                      ///< per predicate
    episodes::RecentFrames recent_;
    std::vector<float> point_;
};

/// Returns the worst frame of each episode among those that rank below half of the other class.
std::vector<WorstFrame> worst(const std::vector<std::vector<RankedFrame>>& groups) {
    constexpr std::size_t kShown = 3;
    std::vector<const RankedFrame*> frames;
    for (const auto& group : groups)
        for (const RankedFrame& frame : group)
            if (frame.ordered < 0.5) frames.push_back(&frame);
    std::sort(frames.begin(), frames.end(), [](const RankedFrame* a, const RankedFrame* b) {
        if (a->ordered != b->ordered) return a->ordered < b->ordered;
        return a->episode != b->episode ? a->episode < b->episode : a->step < b->step;
    });
    std::vector<WorstFrame> result;
    std::set<std::size_t> reported;
    for (const RankedFrame* frame : frames)
        if (result.size() < kShown && reported.insert(frame->episode).second)
            result.push_back({frame->episode, frame->step, frame->positive, frame->ordered});
    return result;
}

}  // namespace

std::vector<Index> separating_predicates(const check::Model& model,
                                         const std::vector<Index>& labelled) {
    std::vector<Index> result;
    for (const Index predicate : labelled) {
        bool rests = false;
        check::for_each_distance(model.predicates[predicate].expression, [&](Index distance) {
            rests = rests || check::rests_on_fitted(model, model.distances[distance]);
        });
        if (rests && !model.predicates[predicate].equality()) result.push_back(predicate);
    }
    return result;
}

std::optional<Index> refused_for(const Filled& filled, Index predicate) {
    const check::Model& model = filled.model;
    std::optional<Index> found;
    const auto look = [&](Index fitted) {
        if (filled.refusals.contains(fitted) && (!found || fitted < *found)) found = fitted;
    };
    check::for_each_distance(model.predicates[predicate].expression, [&](Index d) {
        const check::Distance& distance = model.distances[d];
        if (!distance.is_between_points()) {
            const check::Target& target = model.targets[distance.target];
            look(target.fitted);
            if (target.source != kNone) look(model.targets[target.source].fitted);
        }
        look(distance.weights_fitted);
        for (const Index point : plan::projected_points(model, {d}))
            look(model.projections[model.points[point].projection].fitted);
    });
    return found;
}

std::optional<Need> plain_need(const check::Model& model, Index predicate) {
    std::set<Index> points;
    check::for_each_distance(model.predicates[predicate].expression, [&](Index distance) {
        points.insert(innermost(model, model.distances[distance].point));
        if (model.distances[distance].is_between_points())
            points.insert(innermost(model, model.distances[distance].other));
    });
    if (points.size() != 1 || !check::is_recorded(model, *points.begin())) return std::nullopt;
    return Need{Need::Kind::mean, *points.begin(), kNone, predicate};
}

std::optional<Separations> separate(const std::vector<Filled>& filled, const Solver& solver,
                                    const std::vector<Measured>& predicates, const Request& request,
                                    diag::Sink& sink) {
    Separations result;
    if (predicates.empty()) return result;
    if (filled.size() < 2) {
        result.why_not = "there is one episode";
        return result;
    }
    const check::Model& model = filled.front().model;
    const Collection& collection = solver.collection();
    std::vector<std::unique_ptr<Fold>> folds;
    std::vector<Index> measures;
    for (const Measured& one : predicates) measures.push_back(one.predicate);
    for (const Filled& fold : filled) {
        for (const Index predicate : measures)
            if (const auto refused = refused_for(fold, predicate)) {
                result.why_not = fmt::format("'{}': {}", model.fitted[*refused].name,
                                             fold.refusals.at(*refused).message);
                return result;
            }
        std::vector<std::optional<Vector>> means;
        for (const Index predicate : measures)
            means.push_back(
                mean_of(solver.needs(), plain_need(model, predicate), collection, folds.size()));
        folds.push_back(std::make_unique<Fold>(
            Fold{fold.model, plan::measuring(fold.model, measures), std::move(means)}));
    }
    const std::vector<std::string> paths = collection.recordings.paths();
    const auto measured = episodes::over_episodes<Episode>(paths, request, sink, [&] {
        return std::make_unique<Measurer>(model, folds, collection, predicates);
    });
    if (!measured) return std::nullopt;
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        std::vector<std::vector<RankedFrame>> before(folds.size());
        std::vector<std::vector<RankedFrame>> after(folds.size());
        for (std::size_t e = 0; e < measured->size(); ++e) {
            const Ranked& ranked = (*measured)[e][i];
            auto& to_before = before[collection.fold_of(e)];
            auto& to_after = after[collection.fold_of(e)];
            to_before.insert(to_before.end(), ranked.before.begin(), ranked.before.end());
            to_after.insert(to_after.end(), ranked.after.begin(), ranked.after.end());
        }
        Separation separation{predicates[i].predicate,
                              episodes::auroc(before, paths.size()),
                              episodes::auroc(after, paths.size()),
                              {},
                              {}};
        separation.worst = worst(after);
        for (const auto& group : after)
            for (const RankedFrame& frame : group)
                ++(frame.positive ? separation.labels.positives : separation.labels.negatives);
        result.all.push_back(std::move(separation));
    }
    return result;
}

}  // namespace etlc::fit
