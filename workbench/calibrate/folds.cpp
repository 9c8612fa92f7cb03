#include "calibrate/folds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "check/guarantees/adaptation.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"

namespace etlc::calibrate {

namespace {

using diag::counted;

/// Of one predicate or monitor, over all folds.
struct HeldOut {
    float least = std::numeric_limits<float>::infinity();  ///< threshold
    float greatest = -std::numeric_limits<float>::infinity();
    std::uint64_t without_threshold = 0;  ///< folds whose others give none
    std::uint64_t episodes = 0;           ///< with something to miss
    std::uint64_t covered = 0;            ///< of them, nothing was missed
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
            text += fmt::format("{:.7g} to {:.7g}; held out, nothing is missed in {} of {}", least,
                                greatest, covered, counted(episodes, what));
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

/// What the threshold gets right in the demonstrations of a fold, which it was not taken from.
void judge(const check::Predicate& predicate, float threshold, const Evidence& evidence,
           const Counts& in_fold, HeldOut& result) {
    struct Positives {
        std::uint64_t hits = 0;
        std::uint64_t misses = 0;
    };
    std::vector<Positives> found(evidence.demonstrations);
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
        ++result.episodes;
        result.covered += misses == 0 ? 1 : 0;
    }
}

HeldOut held_out(const check::Predicate& predicate, const Evidence& evidence,
                 const std::vector<std::uint32_t>& fold_of, std::uint32_t folds) {
    HeldOut result;
    for (std::uint32_t fold = 0; fold < folds; ++fold) {
        const auto in_fold = [&](std::uint32_t d) { return fold_of[d] == fold; };
        const Fit found = fit(predicate, evidence, [&](std::uint32_t d) { return !in_fold(d); });
        const auto* fitted = std::get_if<Fitted>(&found);
        if (fitted == nullptr) {
            ++result.without_threshold;
            continue;
        }
        const auto& moves = predicate.threshold.adaptation;
        const float threshold =
            moves ? *check::start(*moves, fitted->epsilon, predicate.upper_bound())
                  : fitted->epsilon;
        result.add(threshold);
        judge(predicate, threshold, evidence, in_fold, result);
    }
    return result;
}

HeldOut held_out(const check::Monitor& monitor, const std::vector<MonitorScores>& episodes,
                 std::size_t of, const std::vector<std::uint32_t>& fold_of, std::uint32_t folds) {
    HeldOut result;
    for (std::uint32_t fold = 0; fold < folds; ++fold) {
        std::vector<double> others;
        for (std::size_t e = 0; e < episodes.size(); ++e)
            if (fold_of[e] != fold && episodes[e][of].steps > 0)
                others.push_back(episodes[e][of].worst);
        Fit found = fit_rank(std::move(others), monitor.calibration->threshold.alpha);
        auto* fitted = std::get_if<Fitted>(&found);
        if (fitted == nullptr) {
            ++result.without_threshold;
            continue;
        }
        const auto beyond = static_cast<double>(fitted->epsilon);
        mirror(*fitted, monitor.calibration->against == check::Against::missed_alarm);
        result.add(fitted->epsilon);
        for (std::size_t e = 0; e < episodes.size(); ++e) {
            const MonitorScore& score = episodes[e][of];
            if (fold_of[e] != fold || score.steps == 0) continue;
            ++result.episodes;
            result.covered += score.worst < beyond ? 1 : 0;
        }
    }
    return result;
}

}  // namespace

std::string report_of_folds(const check::Model& model, const std::vector<Index>& predicates,
                            const std::vector<Evidence>& evidence,
                            const episodes::Identities& episodes, std::uint32_t folds) {
    if (folds == 0) return "";
    const auto fold_of = episodes::folds_of(episodes, folds);
    std::string text = heading(folds);
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        const check::Predicate& predicate = model.predicates[predicates[i]];
        text += held_out(predicate, evidence[i], fold_of, folds)
                    .text(predicate.name, folds, "demonstration");
    }
    return text;
}

std::string report_of_folds(const check::Model& model, const std::vector<Index>& monitors,
                            const std::vector<MonitorScores>& scores,
                            const episodes::Identities& episodes, std::uint32_t folds) {
    if (folds == 0) return "";
    const auto fold_of = episodes::folds_of(episodes, folds);
    std::string text = heading(folds);
    for (std::size_t i = 0; i < monitors.size(); ++i) {
        const check::Monitor& monitor = model.monitors[monitors[i]];
        text += held_out(monitor, scores, i, fold_of, folds).text(monitor.name, folds, "episode");
    }
    return text;
}

}  // namespace etlc::calibrate
