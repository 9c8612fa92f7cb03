// The report that `etlc calibrate` prints, and the errors and warnings about its thresholds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate/calibrate.hpp"
#include "calibrate/fit.hpp"
#include "calibrate/shift.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/numbers/decimal.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/ranking/auroc.hpp"

namespace etlc::calibrate {

namespace {

using check::Claim;
using check::ThresholdOrigin;
using diag::counted;

std::string how(const check::Predicate& predicate, const Fitted& fitted) {
    const check::Threshold& threshold = predicate.threshold;
    const char* const each = threshold.by_group ? "group" : "demonstration";
    const auto place = [&](const char* unit) {
        return describe_place(fitted, predicate.upper_bound(), unit);
    };
    switch (threshold.origin) {
        case ThresholdOrigin::f1:
            return fmt::format("f1: {:.4f} on the {} it was chosen on; no guarantee", fitted.f1,
                               counted(fitted.n, "labelled frame"));
        case ThresholdOrigin::conformal:
            return fmt::format(
                "conformal, alpha = {}: {}\n"
                "    {} is covered with probability >= 1 - {}; given these {}, with {:.3f} to "
                "{:.3f} (5 % and 95 % quantiles of Beta({}, {}), without ties)",
                threshold.alpha, place(each),
                threshold.by_group ? "a demonstration of a new group" : "a new demonstration",
                threshold.alpha,
                threshold.by_group ? counted(fitted.n, "group") : std::to_string(fitted.n),
                check::coverage_quantile(fitted.n, fitted.k, 0.05),
                check::coverage_quantile(fitted.n, fitted.k, 0.95), fitted.k,
                fitted.n + 1 - fitted.k);
        case ThresholdOrigin::class_conditional:
            return fmt::format(
                "class_conditional, alpha = {}: {}\n"
                "    a positive frame is covered with probability >= 1 - {} if frames are "
                "exchangeable, which those of one recording seldom are; no guarantee for episodes",
                threshold.alpha, place("positive frame"), threshold.alpha);
        case ThresholdOrigin::adaptive: {
            const check::Adaptation& moves = *threshold.adaptation;
            return fmt::format(
                "adaptive, alpha = {}, gamma = {}, in [{}, {}]: starts {}\n"
                "    of the first T labelled positive frames it misses at most {}, where H counts "
                "the misses at the end of its range",
                threshold.alpha, moves.gamma, moves.lo, moves.hi, place(each),
                check::miss_bound(predicate));
        }
        case ThresholdOrigin::literal: break;
    }
    return "";
}

std::string predicate_report(const check::Model& model, Index index, const Evidence& evidence,
                             const Fitted& fitted, const OtherError& other) {
    const check::Predicate& predicate = model.predicates[index];
    std::string text =
        fmt::format("\n{}: {}{:.9g}\n    {}\n    labels: {} frames positive, {} negative",
                    predicate.name, predicate.text, predicate.threshold.value,
                    how(predicate, fitted), evidence.positives, evidence.negatives);
    if (evidence.unlabelled > 0)
        text += fmt::format(", {} unknown and left out", evidence.unlabelled);
    text += '\n';
    if (evidence.from_array > 0)
        text += fmt::format(
            "    labels of {} of {} come from an array truth.{} or a table, not from a truth "
            "in the spec\n",
            evidence.from_array, counted(evidence.demonstrations, "demonstration"), predicate.name);
    const bool by_demonstration =
        predicate.threshold.origin == ThresholdOrigin::conformal || predicate.threshold.adaptation;
    if (by_demonstration && evidence.without_score > 0)
        text += fmt::format("    {} without a positive frame left out\n",
                            counted(evidence.without_score, "demonstration"));
    if (evidence.unmeasured > 0)
        text += fmt::format("    {} of unknown distance skipped\n",
                            counted(evidence.unmeasured, "labelled frame"));
    return text + "    " + describe(other);
}

std::string monitor_report(const check::Model& model, const Others& others, bool by_group) {
    std::size_t widest = 0;
    for (const check::Monitor& monitor : model.monitors)
        widest = std::max(widest, monitor.name.size());
    std::string text = "\nguarantees\n";
    bool zero_aside = false;
    std::size_t next = 0;  // guarantees are in this order
    for (const check::Monitor& monitor : model.monitors) {
        if (monitor.calibration) continue;  // its own calibration comes later
        for (const Claim& claim : check::claims(model, monitor)) {
            zero_aside |= claim.zero_aside;
            if (claim.part.empty())
                text += fmt::format("    {:<{}}  {}\n", monitor.name, widest, check::text(claim));
            else
                text += fmt::format("    {:<{}}  of its part {}: {}\n", "", widest, claim.part,
                                    check::text(claim));
            const bool is_next = next < others.guarantees.size() &&
                                 &model.monitors[others.guarantees[next].monitor] == &monitor &&
                                 others.guarantees[next].claim.part == claim.part;
            if (!is_next) continue;
            text += describe(others.by_guarantee[next], others.guarantees[next],
                             std::string(widest + 6, ' '));
            ++next;
        }
    }
    if (zero_aside) text += fmt::format("    {}\n", check::kZeroAside);
    for (const std::string& reservation : model.reservations)
        text += fmt::format("    {}\n", reservation);
    return text +
           (by_group ? "    Probabilities are over the groups of demonstrations and the new group "
                       "together, which must be exchangeable; a group counts once, with the worst "
                       "of its "
                       "demonstrations.\n"
                     : "    Probabilities are over the demonstrations and the new episode "
                       "together, which "
                       "must be exchangeable, per episode as recorded.\n") +
           "    Bounds on successes exclude steps with missing samples.\n" +
           note_on_other_errors(by_group);
}

}  // namespace

std::string in_groups(const episodes::Groups& groups) {
    return groups.are_named() ? " in " + counted(groups.count(), "group") : "";
}

std::string report(const check::Model& model, const std::vector<Index>& predicates,
                   const std::vector<Evidence>& evidence, const episodes::Groups& groups,
                   std::uint64_t frames, const std::vector<Fitted>& fitted, const Others& others) {
    std::string text = fmt::format("{}{}, {}\n", counted(groups.episodes(), "demonstration"),
                                   in_groups(groups), counted(frames, "frame"));
    for (std::size_t i = 0; i < predicates.size(); ++i)
        text +=
            predicate_report(model, predicates[i], evidence[i], fitted[i], others.by_predicate[i]);
    return text + monitor_report(model, others, groups.are_named());
}

// ---- thresholds without each fold, and their results on it --------------------------------------
// Thresholds without each fold, and their results on it.

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

// ---- errors where no threshold can be fitted, and warnings --------------------------------------
// Errors where no threshold can be fitted, and warnings about those that are doubtful.

namespace {

/// Returns the share of the negative frames that the threshold takes for positive, or 0 without
/// any.
double false_part(const check::Predicate& predicate, const Evidence& evidence,
                  const Fitted& fitted) {
    const float epsilon = predicate.upper_bound() ? fitted.epsilon : -fitted.epsilon;
    std::uint64_t within = 0;
    evidence.labelled.for_each([&](const episodes::Scored& frame) {
        const bool holds = frame.score < epsilon || (!predicate.strict() && frame.score == epsilon);
        within += holds && !frame.positive ? 1 : 0;
    });
    const auto negatives = static_cast<double>(evidence.labelled.negatives());
    return negatives == 0 ? 0 : static_cast<double>(within) / negatives;
}

}  // namespace

void refuse_too_few(const check::Threshold& threshold, const TooFew& found, diag::Sink& sink) {
    auto& error =
        sink.report(diag::Code::too_few_scores, threshold.span,
                    fmt::format("alpha = {} needs at least {}{}; there {} {}", threshold.alpha,
                                diag::counted(check::scores_needed(threshold.alpha), found.noun),
                                found.which, found.scores == 1 ? "is" : "are", found.scores));
    if (!found.in_groups.empty())
        error.note(
            fmt::format("{} are in {}, and the episodes of a group count once, with the "
                        "worst of them",
                        found.in_groups, diag::counted(found.all, found.noun)));
    if (found.all <= found.scores) return;
    const std::uint64_t left_out = found.all - found.scores;
    error.note(fmt::format("of {}, {} without such a {} {} left out",
                           diag::counted(found.all, found.noun), left_out, found.unit,
                           left_out == 1 ? "is" : "are"));
}

void refuse_infinite(const std::string& name, const check::Threshold& threshold, const char* what,
                     diag::Sink& sink) {
    sink.report(diag::Code::no_threshold, threshold.span,
                fmt::format("the score of '{}' at the rank of alpha = {} is infinite: no {} lies "
                            "beyond it",
                            name, threshold.alpha, what));
}

void warn_of_large_alpha(const std::string& name, const check::Threshold& threshold,
                         diag::Sink& sink) {
    using check::Decimal;
    if (threshold.alpha.empty() || !(Decimal::parse("0.5") < Decimal::parse(threshold.alpha)))
        return;
    episodes::warn_of_data(
        diag::Code::large_alpha,
        fmt::format("alpha = {} of '{}' allows more than half to be missed", threshold.alpha, name),
        threshold.span, sink)
        .note(check::large_alpha_note(threshold.alpha));
}

void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence,
                    const Fitted& fitted, diag::Sink& sink) {
    constexpr double kNearlyEvery = 0.95;
    warn_of_large_alpha(predicate.name, predicate.threshold, sink);
    const auto warn = [&](std::string message) -> diag::Diagnostic& {
        return episodes::warn_of_data(diag::Code::doubtful_threshold, std::move(message),
                                      predicate.threshold.span, sink);
    };
    const auto ranked =
        episodes::auroc(evidence.labelled, evidence.groups, episodes::Likely::smaller);
    if (episodes::warn_of_labels(predicate, {evidence.positives, evidence.negatives}, ranked, sink))
        return;
    if (ranked && ranked->interval && ranked->interval->low <= 0.5) {
        warn(fmt::format("what '{}' measures does not tell its labels apart: the area under the "
                         "ROC curve is {:.2f}, with a 95 % interval from {:.2f} to {:.2f}",
                         predicate.name, ranked->value, ranked->interval->low,
                         ranked->interval->high))
            .note("0.5 is chance: check the labels, the embedding and the targets");
        return;
    }
    const double part = false_part(predicate, evidence, fitted);
    if (part < kNearlyEvery) return;
    warn(fmt::format("with the threshold {:.9g}, '{}' is true at {:.0f} % of the frames labelled "
                     "false",
                     fitted.epsilon, predicate.name, std::floor(100 * part)))
        .note("a weaker guarantee, more targets or other labels may make it narrower");
}

}  // namespace etlc::calibrate
