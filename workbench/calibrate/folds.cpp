// Thresholds without each fold, and their results on it.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "calibrate/shift.hpp"
#include "check/guarantees/adaptation.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"

namespace etlc::calibrate {

namespace {

using diag::counted;

/// Results of a predicate or monitor over all folds.
struct HeldOut {
    float least = std::numeric_limits<float>::infinity();  ///< threshold
    float greatest = -std::numeric_limits<float>::infinity();
    std::uint64_t without_threshold = 0;  ///< folds without which there is no threshold
    std::uint64_t groups = 0;             ///< held-out groups with something to miss
    std::uint64_t covered = 0;            ///< those in which nothing was missed
    std::uint64_t hits = 0;               ///< frames
    std::uint64_t false_alarms = 0;
    std::uint64_t misses = 0;

    void add(float threshold) {
        least = std::min(least, threshold);
        greatest = std::max(greatest, threshold);
    }

    std::string text(const std::string& name, std::uint32_t folds, const char* what) const {
        std::string text = fmt::format("    {}: ", name);
        if (least <= greatest)
            text += fmt::format("{:.7g} to {:.7g}; held out, {} of {} miss nothing", least,
                                greatest, covered, counted(groups, what));
        if (const std::uint64_t frames = 2 * hits + false_alarms + misses; frames > 0)
            text += fmt::format(", F1 of the frames {:.3f}",
                                2 * static_cast<double>(hits) / static_cast<double>(frames));
        if (without_threshold > 0)
            text += fmt::format("{}no threshold without {} of the {} folds",
                                least <= greatest ? "; " : "", without_threshold, folds);
        return text + "\n";
    }
};

std::string heading(std::uint32_t folds) {
    return fmt::format("\nthresholds without each of {} folds; no guarantee follows from them\n",
                       folds);
}

/// Adds the results of the threshold in the groups of the fold that it was fitted without.
void judge(const check::Predicate& predicate, float threshold, const Evidence& evidence,
           const Counts& in_fold, HeldOut& result) {
    struct Positives {
        std::uint64_t hits = 0;
        std::uint64_t misses = 0;
    };
    std::vector<Positives> found(evidence.groups);
    evidence.labelled.for_each([&](const episodes::Scored& frame) {
        if (!in_fold(frame.episode)) return;
        const float delta = predicate.upper_bound() ? frame.score : -frame.score;
        const bool holds = check::holds(predicate.comparison, delta, threshold);
        if (frame.positive)
            ++(holds ? found[frame.episode].hits : found[frame.episode].misses);
        else
            result.false_alarms += holds ? 1 : 0;
    });
    for (const auto& [hits, misses] : found) {
        result.hits += hits;
        result.misses += misses;
        if (hits + misses == 0) continue;
        ++result.groups;
        result.covered += misses == 0 ? 1 : 0;
    }
}

/// Calls `judge_fold(fold, fitted, result)` with the fit that `fit_others(fold)` returns for each.
template <class FitOthers, class Judge>
HeldOut held_out(std::uint32_t folds, const FitOthers& fit_others, const Judge& judge_fold) {
    HeldOut result;
    for (std::uint32_t fold = 0; fold < folds; ++fold) {
        Fit found = fit_others(fold);
        if (auto* fitted = std::get_if<Fitted>(&found))
            judge_fold(fold, *fitted, result);
        else
            ++result.without_threshold;
    }
    return result;
}

}  // namespace

std::string report_of_folds(const check::Model& model, const std::vector<Index>& predicates,
                            const std::vector<Evidence>& evidence,
                            const episodes::Identities& episodes, const episodes::Groups& groups,
                            std::uint32_t folds) {
    if (folds == 0) return "";
    const auto fold_of = episodes::folds_of(episodes, groups, folds);
    std::string text = heading(folds);
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        const check::Predicate& predicate = model.predicates[predicates[i]];
        const auto fit_others = [&](std::uint32_t fold) {
            return fit(predicate, evidence[i], [&](std::uint32_t g) { return fold_of[g] != fold; });
        };
        const auto judge_fold = [&](std::uint32_t fold, const Fitted& fitted, HeldOut& result) {
            const auto& moves = predicate.threshold.adaptation;
            const float threshold =
                moves ? *check::start(*moves, fitted.epsilon, predicate.upper_bound())
                      : fitted.epsilon;
            result.add(threshold);
            const auto in_fold = [&](std::uint32_t g) { return fold_of[g] == fold; };
            judge(predicate, threshold, evidence[i], in_fold, result);
        };
        text += held_out(folds, fit_others, judge_fold)
                    .text(predicate.name, folds, groups.are_named() ? "group" : "demonstration");
    }
    return text;
}

std::string report_of_folds(const check::Model& model, const std::vector<Index>& monitors,
                            const std::vector<MonitorScores>& scores,
                            const episodes::Identities& episodes, const episodes::Groups& groups,
                            std::uint32_t folds) {
    if (folds == 0) return "";
    const auto fold_of = episodes::folds_of(episodes, groups, folds);
    std::string text = heading(folds);
    for (std::size_t i = 0; i < monitors.size(); ++i) {
        const check::Monitor& monitor = model.monitors[monitors[i]];
        const auto fit_others = [&](std::uint32_t fold) {
            std::vector<double> others;
            for (std::size_t g = 0; g < scores.size(); ++g)
                if (fold_of[g] != fold && scores[g][i].steps > 0)
                    others.push_back(scores[g][i].worst);
            return fit_rank(std::move(others), monitor.calibration->threshold.alpha);
        };
        const auto judge_fold = [&](std::uint32_t fold, Fitted& fitted, HeldOut& result) {
            const auto beyond = static_cast<double>(fitted.epsilon);
            mirror(fitted, monitor.calibration->against == check::Against::missed_alarm);
            result.add(fitted.epsilon);
            for (std::size_t g = 0; g < scores.size(); ++g) {
                const MonitorScore& score = scores[g][i];
                if (fold_of[g] != fold || score.steps == 0) continue;
                ++result.groups;
                result.covered += score.worst < beyond ? 1 : 0;
            }
        };
        text += held_out(folds, fit_others, judge_fold)
                    .text(monitor.name, folds, groups.are_named() ? "group" : "episode");
    }
    return text;
}

}  // namespace etlc::calibrate
