#include "fit/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/algebra/dense.hpp"

namespace etlc::fit {

using check::Fitted;
using check::FittedMethod;
using diag::Code;
using diag::counted;
using Outcome = std::variant<Solution, Refusal>;

namespace {

/// Returns the maps of a point, innermost first.
std::vector<Affine> maps_of(const check::Model& model, Index point) {
    std::vector<Affine> maps;
    for (; model.points[point].is_projected(); point = model.points[point].inner) {
        const check::Projection& map = model.projections[model.points[point].projection];
        using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Affine affine;
        affine.a =
            Eigen::Map<const RowMajor>(map.matrix.data(), map.rows, map.dimension).cast<double>();
        affine.offset = Vector::Zero(map.dimension);
        if (!map.offset.empty())
            affine.offset =
                Eigen::Map<const Eigen::VectorXf>(map.offset.data(), map.dimension).cast<double>();
        maps.push_back(std::move(affine));
    }
    std::reverse(maps.begin(), maps.end());
    return maps;
}

/// Converts to float32, row-major.
std::vector<float> floats(const Matrix& matrix) {
    std::vector<float> result;
    result.reserve(static_cast<std::size_t>(matrix.size()));
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j)
            result.push_back(static_cast<float>(matrix(i, j)));
    return result;
}

check::Filling filling(const Affine& map) {
    return {floats(map.a), floats(map.offset.transpose())};
}

}  // namespace

/// Solves one fit.
class Solving {
public:
    Solving(Solver& solver, const check::Model& model, Index fitted,
            std::optional<std::size_t> left_out)
        : solver_(solver),
          part_{solver.needs_.of[fitted], left_out, {}},
          fitted_(model.fitted[fitted]),
          maps_(maps_of(model, fitted_.point)) {
        const Collection& collection = solver.collection_;
        for (std::size_t f = 0; f < collection.folds.size(); ++f)
            if (left_out != f) folds_.push_back(&collection.folds[f][part_.need]);
        for (const Collected* fold : folds_) solution_.counts.add(fold->counts);
    }

    Outcome run() {
        if (solution_.counts.holds == 0)
            return Refusal{
                Code::too_few_frames,
                fmt::format(
                    "there is none among {} at which 'where' holds and the point is present",
                    counted(solution_.counts.frames(), "frame"))};
        switch (fitted_.method) {
            case FittedMethod::mean: return mean();
            case FittedMethod::kmeans:
            case FittedMethod::medoids: return clusters();
            case FittedMethod::pca: return components(false);
            case FittedMethod::whitened_pca: return components(true);
            case FittedMethod::discriminant: return of_two_classes();
            case FittedMethod::logpzo: break;
        }
        return of_covariance();
    }

private:
    Moments moments_of(const Collected& fold) const {
        Moments result = fold.moments;
        for (const Affine& map : maps_) result = result.mapped(map);
        return result;
    }

    /// Returns the moments of all folds together.
    Moments moments() const {
        Moments result = solver_.moments(part_);
        for (const Affine& map : maps_) result = result.mapped(map);
        return result;
    }

    Outcome finished(check::Filling numbers) {
        const auto is_number = [](float x) { return std::isfinite(x); };
        if (!std::all_of(numbers.matrix.begin(), numbers.matrix.end(), is_number) ||
            !std::all_of(numbers.offset.begin(), numbers.offset.end(), is_number))
            return Refusal{Code::fit_out_of_range, "its numbers exceed float32"};
        solution_.filling = std::move(numbers);
        return std::move(solution_);
    }

    Outcome mean() { return finished({floats(moments().mean(kHolds).transpose()), {}}); }

    std::optional<Refusal> too_few_for(std::uint64_t needed, const std::string& what) const {
        if (solution_.counts.holds >= needed) return std::nullopt;
        return Refusal{
            Code::too_few_frames,
            fmt::format("{} takes at least {}; there {} {}", what, counted(needed, "frame"),
                        solution_.counts.holds == 1 ? "is" : "are", solution_.counts.holds)};
    }

    Outcome components(bool whitened) {
        if (auto refusal =
                too_few_for(std::uint64_t{fitted_.rows} + 1, fmt::format("r = {}", fitted_.rows)))
            return *refusal;
        solution_.constant = moments().constants();
        const Components found =
            principal_components(maps_.empty() ? solver_.variances(part_, fitted_.rows)
                                               : greatest_variances(moments(), fitted_.rows),
                                 fitted_.rows, whitened);
        if (found.rank < fitted_.rows)
            return Refusal{
                Code::degenerate_frames,
                fmt::format("r = {}, but the frames vary in only {}", fitted_.rows,
                            counted(static_cast<std::uint64_t>(found.rank), "direction"))};
        solution_.explained = found.explained;
        return finished(filling(found.map));
    }

    Outcome of_covariance() {
        if (auto refusal = too_few_for(2, "a covariance")) return *refusal;
        const Moments all = moments();
        solution_.constant = all.constants();
        const auto map = logpzo(all);
        if (map) return finished(filling(*map));
        return Refusal{Code::degenerate_frames,
                       "some directions vary so much more than others that I + S has no inverse"};
    }

    Outcome of_two_classes() {
        if (solution_.counts.others == 0)
            return Refusal{Code::class_without_frames,
                           fmt::format("'where' holds at all {} with a point; a discriminant "
                                       "needs others as well",
                                       counted(solution_.counts.holds, "frame"))};
        solution_.shrinkage = best_shrinkage(trials());
        if (!solution_.shrinkage)
            return Refusal{
                Code::too_few_frames,
                fmt::format("how far a covariance is shrunk is chosen by cross-validation: that "
                            "takes frames of both classes in two episodes at least, and a "
                            "variance within the classes; 'where' holds in {} of {}",
                            solution_.counts.episodes,
                            counted(solver_.collection_.recordings.episodes().size(), "episode"))};
        const Moments all = moments();
        solution_.constant = all.constants();
        if (fitted_.slot == Fitted::Slot::metric) {
            const auto inverse = metric(all, *solution_.shrinkage);
            if (inverse && is_definite(*inverse)) return finished({floats(*inverse), {}});
        } else if (const auto map = discriminant(all, *solution_.shrinkage)) {
            return finished(filling(*map));
        }
        return Refusal{Code::degenerate_frames,
                       "the covariance within the classes has no inverse in float32, or the "
                       "classes have the same mean"};
    }

    /// Tests each fold with the fit on the other folds, without the one that is left out. If none
    /// is left out, leaves each out in turn where enough remain: these are the trials of the fits
    /// without a fold, which are cached.
    std::vector<Trial> trials() const {
        constexpr std::size_t kEnough = 4;
        const std::size_t folds = solver_.collection_.folds.size();
        std::vector<std::optional<std::size_t>> left_out{part_.first};
        if (!part_.first && folds >= kEnough) left_out.assign(folds, std::nullopt);
        for (std::size_t f = 0; left_out.size() > 1 && f < folds; ++f) left_out[f] = f;
        std::vector<Moments> mapped;
        if (!maps_.empty())
            for (const auto& fold : solver_.collection_.folds)
                mapped.push_back(moments_of(fold[part_.need]));
        std::vector<Trial> result;
        for (const std::optional<std::size_t> without : left_out)
            for (std::size_t test = 0; test < folds; ++test)
                if (without != test)
                    result.push_back(maps_.empty() ? solver_.trial({part_.need, without, {}}, test)
                                                   : trial(mapped, without, test));
        return result;
    }

    static Trial trial(const std::vector<Moments>& folds, std::optional<std::size_t> without,
                       std::size_t test) {
        Moments training(folds[test].dimension());
        for (std::size_t f = 0; f < folds.size(); ++f)
            if (f != test && without != f) training.merge(folds[f]);
        return fit::trials(training, {&folds[test]}).front();
    }

    /// Checks the matrix as rounded to float32.
    static bool is_definite(const Matrix& metric) {
        return Cholesky::of(metric.cast<float>().cast<double>()).has_value();
    }

    Outcome clusters() {
        const TakenPoints& all = solver_.points(part_.need);
        Members members;
        for (std::size_t i = 0; i < all.sources.size(); ++i)
            if (!part_.first ||
                solver_.collection_.fold_of(all.sources[i]->episode) != *part_.first)
                members.push_back(static_cast<Eigen::Index>(i));
        solution_.taken = members.size();
        if (members.size() < fitted_.rows) return too_few_taken(members.size(), "");
        if (maps_.empty()) return clusters(all, all.points, members, members);
        Members numbers(members.size());
        std::iota(numbers.begin(), numbers.end(), 0);
        return clusters(all, Points(mapped(all.frames(members))), numbers, members);
    }

    /// `members`: indices of points; `taken`: their indices among all frames taken.
    Outcome clusters(const TakenPoints& all, const Points& points, const Members& members,
                     const Members& taken) {
        const auto centres = k_means(points, members, static_cast<Eigen::Index>(fitted_.rows));
        if (!centres) return too_few_taken(members.size(), " different");
        if (fitted_.method == FittedMethod::kmeans)
            return finished({floats(centres->transpose()), {}});
        Members medoids;
        for (const std::size_t i : nearest_points(points, members, *centres)) {
            medoids.push_back(taken[i]);
            solution_.medoids.push_back(all.sources[static_cast<std::size_t>(medoids.back())]);
        }
        return finished({floats(mapped(all.frames(medoids)).transpose()), {}});
    }

    Matrix mapped(Matrix frames) const {
        for (const Affine& map : maps_) frames = map(frames);
        return frames;
    }

    Refusal too_few_taken(std::size_t taken, std::string_view different) const {
        return {Code::too_few_frames,
                fmt::format("k = {} takes at least {}{} frames; {} can be taken{}", fitted_.rows,
                            fitted_.rows, different, taken,
                            fitted_.away == 0
                                ? ""
                                : fmt::format(", {} or more away from where 'where' changes",
                                              counted(fitted_.away, "step")))};
    }

    Solver& solver_;
    Solver::Part part_;
    const Fitted& fitted_;
    std::vector<Affine> maps_;
    std::vector<const Collected*> folds_;
    Solution solution_;
};

namespace {

Need::Kind kind_of(FittedMethod method) {
    switch (method) {
        case FittedMethod::mean: return Need::Kind::mean;
        case FittedMethod::medoids:
        case FittedMethod::kmeans: return Need::Kind::frames;
        case FittedMethod::discriminant: return Need::Kind::classes;
        case FittedMethod::pca:
        case FittedMethod::whitened_pca:
        case FittedMethod::logpzo: break;
    }
    return Need::Kind::scatter;
}

}  // namespace

std::size_t Needs::add(const Need& need) {
    const auto found = std::find(all.begin(), all.end(), need);
    if (found == all.end()) {
        all.push_back(need);
        return all.size() - 1;
    }
    return static_cast<std::size_t>(found - all.begin());
}

Needs needs_of(const check::Model& model) {
    Needs result;
    for (const Fitted& fitted : model.fitted)
        result.of.push_back(result.add({kind_of(fitted.method), innermost(model, fitted.point),
                                        fitted.where, check::kNone, fitted.away}));
    return result;
}

TakenPoints::TakenPoints(const Collection& collection, std::size_t need, unsigned jobs) {
    for (const std::vector<Collected>& fold : collection.folds)
        for (const Source& source : fold[need].frames) sources.push_back(&source);
    std::sort(sources.begin(), sources.end(), [](const Source* a, const Source* b) {
        return a->episode != b->episode ? a->episode < b->episode : a->frame.step < b->frame.step;
    });
    Members all(sources.size());
    std::iota(all.begin(), all.end(), 0);
    if (!all.empty()) points = Points(frames(all), jobs);
}

Matrix TakenPoints::frames(const Members& members) const {
    Matrix result(static_cast<Eigen::Index>(sources.front()->frame.values.size()),
                  static_cast<Eigen::Index>(members.size()));
    for (std::size_t i = 0; i < members.size(); ++i)
        result.col(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::VectorXf>(
                sources[static_cast<std::size_t>(members[i])]->frame.values.data(), result.rows())
                .cast<double>();
    return result;
}

Moments Solver::moments(const Part& part) const {
    std::optional<Moments> result;
    for (std::size_t f = 0; f < collection_.folds.size(); ++f) {
        if (part.first == f || part.second == f) continue;
        const Moments& fold = collection_.folds[f][part.need].moments;
        if (result)
            result->merge(fold);
        else
            result = fold;
    }
    return *result;
}

Trial Solver::trial(const Part& part, std::size_t test) {
    Part without{part.need, test, part.first};
    if (without.second && *without.second < test) std::swap(without.first, without.second);
    const std::vector<Trial>& both = trials_.get(without, [&] {
        std::vector<const Moments*> tests;
        for (const std::optional<std::size_t> fold : {without.first, without.second})
            if (fold) tests.push_back(&collection_.folds[*fold][part.need].moments);
        if (tests.size() == collection_.folds.size()) return std::vector<Trial>(tests.size());
        return trials(moments(without), tests);
    });
    return both[without.first == test ? 0 : 1];
}

const Variances& Solver::variances(const Part& part, Eigen::Index r) {
    r = std::max(r, kLeastVariances);
    return variances_.get({part, r}, [&] { return greatest_variances(moments(part), r); });
}

const TakenPoints& Solver::points(std::size_t need, unsigned jobs) {
    return points_.get(need, [&] { return TakenPoints(collection_, need, jobs); });
}

void Solver::prepare(const check::Model& model, unsigned jobs) {
    for (std::size_t i = 0; i < model.fitted.size(); ++i)
        if (needs_.all[needs_.of[i]].kind == Need::Kind::frames &&
            !model.points[model.fitted[i].point].is_projected())
            points(needs_.of[i], jobs);
}

std::variant<Solution, Refusal> Solver::solve(const check::Model& model, Index fitted,
                                              std::optional<std::size_t> left_out) {
    return Solving(*this, model, fitted, left_out).run();
}

}  // namespace etlc::fit
