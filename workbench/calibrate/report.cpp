// The report that `etlc calibrate` prints, and the errors and warnings about its thresholds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "calibrate/calibrate.hpp"
#include "calibrate/fit.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/numbers/decimal.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/ranking/auroc.hpp"

namespace etlc::calibrate {

namespace {

using check::Guarantee;
using check::ThresholdOrigin;
using diag::counted;

/// Returns the truth of the frames at which the error can happen, and what it says there.
const char* true_word(const Subject& of, const Aim& aim) {
    if (of.is_monitor) return aim.of_positives ? "satisfied" : "violated";
    return aim.of_positives ? "true" : "false";
}
const char* wrong_word(const Subject& of, Aim aim) {
    aim.of_positives = !aim.of_positives;
    return true_word(of, aim);
}

/// Returns "alpha = 0.1 needs at least 9 demonstrations in which 'p' is true at some frame; there
/// are 5".
std::string needed(const Subject& of, const Aim& aim, std::uint64_t n) {
    const bool by_frame = of.predicate.threshold.origin == ThresholdOrigin::class_conditional;
    return fmt::format(
        "{} = {} needs at least {}{}; there {} {}", aim.rate_name, aim.rate,
        counted(check::scores_needed(aim.rate), by_frame ? "positive frame" : of.noun()),
        by_frame ? "" : of.which(aim), n == 1 ? "is" : "are", n);
}

/// Returns what a threshold against false positives, or both errors, promises.
std::string promise(const check::Predicate& predicate) {
    std::string text;
    for (const Aim& aim : aims_of(predicate))
        text +=
            fmt::format("{}no {} frame is called {} with probability >= 1 - {}",
                        text.empty() ? "" : ", and ", aim.of_positives ? "positive" : "negative",
                        aim.of_positives ? "false" : "true", aim.rate);
    return fmt::format(
        "{}\n    in a {}, {}", check::origin(predicate.threshold),
        predicate.threshold.by_group ? "demonstration of a new group" : "new demonstration", text);
}

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
        case ThresholdOrigin::normal:
            if (threshold.against != check::Against::misses) return promise(predicate);
            return fmt::format(
                "{}, alpha = {}: {}\n"
                "    {} is covered with probability >= 1 - {}; given these {}, with {:.3f} to "
                "{:.3f} (5 % and 95 % quantiles of Beta({}, {}), without ties)",
                check::method_name(threshold.origin), threshold.alpha, place(each),
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
        case ThresholdOrigin::risk: return check::origin(threshold);
        case ThresholdOrigin::literal: break;
    }
    return "";
}

std::string predicate_report(const check::Model& model, Index index, const Evidence& evidence,
                             const Sides& sides, const OtherError& other) {
    const check::Predicate& predicate = model.predicates[index];
    const check::Threshold& threshold = predicate.threshold;
    std::string text = fmt::format(
        "\n{}: {}{}\n    {}\n", predicate.name, predicate.text,
        threshold.inner ? check::numbers(threshold) : fmt::format("{:.9g}", threshold.value),
        how(predicate, sides.front()));
    if (is_normal(threshold)) {
        text += fmt::format("    {} taken as normal", counted(evidence.positives.frames, "frame"));
        if (evidence.unmeasured > 0)
            text += fmt::format(", {} of unknown distance skipped", evidence.unmeasured);
        return text + "\n" + describe_failures(evidence.failures);
    }
    text += fmt::format("    labels: {} frames positive, {} negative", evidence.positives.frames,
                        evidence.negatives.frames);
    if (evidence.unlabelled > 0)
        text += fmt::format(", {} unknown{} and left out", evidence.unlabelled,
                            threshold.within > 0 ? " or near a change" : "");
    text += '\n';
    if (evidence.from_array > 0)
        text += fmt::format(
            "    labels of {} of {} come from an array truth.{} or a table, not from a truth "
            "in the spec\n",
            evidence.from_array, counted(evidence.demonstrations, "demonstration"), predicate.name);
    text += describe_sides({predicate, evidence, false, threshold.by_group}, sides);
    if (evidence.unmeasured > 0)
        text += fmt::format("    {} of unknown distance {}\n",
                            counted(evidence.unmeasured, "labelled frame"),
                            threshold.origin == ThresholdOrigin::risk ? "counted" : "skipped");
    return text + "    " + describe(other, threshold.against);
}

std::string monitor_report(const check::Model& model, const Others& others, bool by_group) {
    std::size_t widest = 0;
    for (const check::Monitor& monitor : model.monitors)
        widest = std::max(widest, monitor.name.size());
    std::string text = "\nguarantees\n";
    bool zero_aside = false;
    bool of_successes = false;
    const bool with_cost = has_cost(others.guarantees) ||
                           std::any_of(model.predicates.begin(), model.predicates.end(),
                                       [](const check::Predicate& p) {
                                           return p.threshold.against == check::Against::both;
                                       });
    std::size_t next = 0;  // guarantees are in this order
    for (const check::Monitor& monitor : model.monitors) {
        const bool is_later = monitor.duration && !monitor.duration->is_known;
        if (monitor.calibration || is_later) continue;  // its own calibration comes later
        const std::vector<Guarantee> guarantees = check::guarantees(model, monitor);
        for (std::size_t c = 0; c < guarantees.size(); ++c) {
            const Guarantee& guarantee = guarantees[c];
            zero_aside |= guarantee.zero_aside;
            of_successes |= guarantee.kind == Guarantee::Kind::missed_success;
            text += fmt::format("    {:<{}}  {}\n", c == 0 ? monitor.name : "", widest,
                                check::text(guarantee));
            const bool is_next = next < others.guarantees.size() &&
                                 &model.monitors[others.guarantees[next].monitor] == &monitor &&
                                 others.guarantees[next].guarantee.part == guarantee.part;
            // The lines of one formula come first.
            const bool is_last =
                c + 1 == guarantees.size() || guarantees[c + 1].part != guarantee.part;
            if (!is_next || !is_last) continue;
            text += describe(others.by_guarantee[next], others.guarantees[next],
                             std::string(widest + 6, ' '));
            ++next;
        }
    }
    if (zero_aside) text += fmt::format("    {}\n", check::kZeroAside);
    for (const std::string& reservation : model.reservations)
        text += fmt::format("    {}\n", reservation);
    text += fmt::format("    {}\n", check::exchangeability(by_group));
    if (of_successes) text += fmt::format("    {}\n", check::kMissingAside);
    const bool reads_labels = std::any_of(
        model.predicates.begin(), model.predicates.end(), [](const check::Predicate& p) {
            return p.threshold.origin != ThresholdOrigin::literal && !is_normal(p.threshold);
        });
    return reads_labels ? text + note_on_other_errors(by_group, with_cost) : text;
}

}  // namespace

std::string describe_failures(std::uint64_t failures) {
    if (failures == 0) return "";
    return fmt::format("    {} left out, which failed or whose outcome is unknown\n",
                       counted(failures, "episode"));
}

std::string describe_sides(const Subject& of, const Sides& sides) {
    const check::Threshold& threshold = of.predicate.threshold;
    const bool by_risk = threshold.origin == ThresholdOrigin::risk;
    std::string text;
    const std::vector<Aim> aims = aims_of(of.predicate);
    const bool is_halfway = aims.size() == 2 && !joined(of.predicate, sides).inner;
    const bool by_episode = by_risk || threshold.bounds_episodes() || threshold.adaptation;
    for (std::size_t i = 0; by_episode && i < aims.size(); ++i) {
        const Aim& aim = aims[i];
        const Evidence::Side& side = of.evidence.side(aim.of_positives);
        const Fitted& fitted = sides[i];
        const std::string called = fmt::format("called {}", wrong_word(of, aim));
        if (std::isinf(fitted.epsilon))
            text += fmt::format("    never {}: {}\n", called, needed(of, aim, fitted.n));
        else if (by_risk)
            text += fmt::format(
                "    {} at {}{:.1f} % of the {}s at which it is {}, on average over these {}s\n",
                called, is_halfway ? "no more than " : "",
                100 * std::accumulate(fitted.losses.begin(), fitted.losses.end(), 0.0) /
                    static_cast<double>(fitted.n),
                of.unit(), true_word(of, aim), of.noun());
        std::uint64_t left_out = side.without_score;
        if (by_risk) left_out = of.evidence.demonstrations - side.episodes.size();
        if (of.is_monitor) left_out = of.evidence.groups - fitted.n;
        const std::string without =
            !of.is_monitor     ? aim.of_positives ? "a positive frame" : "a negative frame"
            : aims.size() == 1 ? "such a step"
                               : fmt::format("a truly {} step", true_word(of, aim));
        if (left_out > 0)
            text += fmt::format("    {} without {} left out\n",
                                counted(left_out, of.is_monitor ? of.noun() : "demonstration"),
                                without);
    }
    return text;
}

std::string in_groups(const episodes::Groups& groups) {
    return groups.are_named() ? " in " + counted(groups.count(), "group") : "";
}

std::string report(const check::Model& model, const std::vector<Index>& predicates,
                   const std::vector<Evidence>& evidence, const episodes::Groups& groups,
                   std::uint64_t frames, const std::vector<Sides>& fitted, const Others& others) {
    std::string text = fmt::format("{}{}, {}\n", counted(groups.episodes(), "demonstration"),
                                   in_groups(groups), counted(frames, "frame"));
    for (std::size_t i = 0; i < predicates.size(); ++i)
        text +=
            predicate_report(model, predicates[i], evidence[i], fitted[i], others.by_predicate[i]);
    return text + monitor_report(model, others, groups.are_named());
}

// ---- thresholds without each fold, and their results on it --------------------------------------

namespace {

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

    void add(const check::Both& both) {
        for (const float threshold : {both.value, both.low()}) {
            least = std::min(least, threshold);
            greatest = std::max(greatest, threshold);
        }
    }

    std::string text(const Subject& of, std::uint32_t folds) const {
        const check::Threshold& threshold = of.predicate.threshold;
        std::string text = fmt::format("    {}: ", of.predicate.name);
        if (least <= greatest)
            text += fmt::format(
                "{:.7g} to {:.7g}; held out, {} of {} {}", least, greatest, covered,
                counted(groups, of.noun()),
                is_against(threshold, true) && is_against(threshold, false) ? "have no error"
                : is_against(threshold, true) || of.is_monitor              ? "miss nothing"
                                                               : "have no false positive");
        if (const std::uint64_t frames = 2 * hits + false_alarms + misses; frames > 0)
            text += fmt::format(", F1 of the frames {:.3f}",
                                2 * static_cast<double>(hits) / static_cast<double>(frames));
        if (without_threshold > 0)
            text += fmt::format("{}no threshold without {} of the {} folds",
                                least <= greatest ? "; " : "", without_threshold, folds);
        return text + "\n";
    }
};

/// Adds the results of the thresholds in the groups of the fold that they were fitted without.
void judge_frames(const check::Predicate& predicate, const check::Both& both,
                  const Evidence& evidence, const Counts& in_fold, HeldOut& result) {
    struct Found {
        std::uint64_t frames = 0;  ///< at which an error that it is against can happen
        std::uint64_t errors = 0;
    };
    std::vector<Found> found(evidence.groups);
    evidence.labelled.for_each([&](const episodes::Scored& frame) {
        if (!in_fold(frame.episode)) return;
        const float delta = predicate.upper_bound() ? frame.score : -frame.score;
        const auto called = check::called(predicate.comparison, delta, both.low(), both.value);
        result.hits += frame.positive && called == true ? 1 : 0;
        result.misses += frame.positive && called == false ? 1 : 0;
        result.false_alarms += !frame.positive && called == true ? 1 : 0;
        if (!is_against(predicate.threshold, frame.positive)) return;
        ++found[frame.episode].frames;
        found[frame.episode].errors += called == !frame.positive ? 1 : 0;
    });
    for (const auto& [frames, errors] : found) {
        result.groups += frames > 0 ? 1 : 0;
        result.covered += frames > 0 && errors == 0 ? 1 : 0;
    }
}

/// The same of a monitor, by its worst scores.
void judge_worst(const std::vector<Aim>& aims, const Sides& sides, const Evidence& evidence,
                 const Counts& in_fold, HeldOut& result) {
    std::map<std::uint32_t, bool> covered;
    for (std::size_t i = 0; i < aims.size(); ++i) {
        const auto beyond = static_cast<double>(sides[i].epsilon);
        for (const auto& [reach, group, episode] : evidence.side(aims[i].of_positives).worst) {
            if (!in_fold(group)) continue;
            const bool is_within = reach < (aims[i].above ? beyond : -beyond);
            covered.emplace(group, true).first->second &= is_within;
        }
    }
    for (const auto& [group, is_covered] : covered) {
        ++result.groups;
        result.covered += is_covered ? 1 : 0;
    }
}

HeldOut held_out(const Subject& of, const std::vector<std::uint32_t>& fold_of,
                 std::uint32_t folds) {
    HeldOut result;
    const check::Predicate& predicate = of.predicate;
    const std::vector<Aim> aims = aims_of(predicate);
    for (std::uint32_t fold = 0; fold < folds; ++fold) {
        const auto in_fold = [&](std::uint32_t g) { return fold_of[g] == fold; };
        Sides sides;
        for (const Aim& aim : aims) {
            const Fit found =
                fit(predicate, aim, of.evidence, [&](std::uint32_t g) { return !in_fold(g); });
            if (const auto* fitted = std::get_if<Fitted>(&found)) sides.push_back(*fitted);
        }
        if (sides.size() < aims.size()) {
            ++result.without_threshold;
            continue;
        }
        check::Both both = joined(predicate, sides);
        if (const auto& moves = predicate.threshold.adaptation)
            both.value = *check::start(*moves, both.value, predicate.upper_bound());
        result.add(both);
        if (of.is_monitor)
            judge_worst(aims, sides, of.evidence, in_fold, result);
        else
            judge_frames(predicate, both, of.evidence, in_fold, result);
    }
    return result;
}

}  // namespace

std::string report_of_folds(const std::vector<Subject>& subjects,
                            const episodes::Identities& episodes, const episodes::Groups& groups,
                            std::uint32_t folds) {
    if (folds == 0) return "";
    const auto fold_of = episodes::folds_of(episodes, groups, folds);
    std::string text = fmt::format(
        "\nthresholds without each of {} folds; no guarantee follows from them\n", folds);
    for (const Subject& subject : subjects)
        text += held_out(subject, fold_of, folds).text(subject, folds);
    return text;
}

// ---- errors where no threshold can be fitted, and warnings about doubtful ones ------------------

namespace {

/// Returns the share of the frames of the opposite label at which the predicate is `predicted`, or
/// 0 without any.
double wrong_part(const check::Predicate& predicate, const Evidence& evidence, float threshold,
                  bool predicted) {
    std::uint64_t all = 0;
    std::uint64_t wrong = 0;
    evidence.labelled.for_each([&](const episodes::Scored& frame) {
        if (frame.positive == predicted) return;
        const float delta = predicate.upper_bound() ? frame.score : -frame.score;
        ++all;
        wrong += check::holds(predicate.comparison, delta, threshold) == predicted ? 1 : 0;
    });
    return all == 0 ? 0 : static_cast<double>(wrong) / static_cast<double>(all);
}

/// Says how many truths are open, where that may be why cases are few.
void note_open(const Subject& of, diag::Diagnostic& error) {
    const std::uint64_t open = of.evidence.unlabelled;
    if (of.predicate.threshold.within > 0 && open > 0)
        error.note(fmt::format("its truth is open at {}, most of them within {} of a change",
                               counted(open, of.unit()),
                               counted(of.predicate.threshold.within, "step")));
}

void refuse_without_case(const check::Model& model, const Subject& of, const Aim& aim,
                         diag::Sink& sink) {
    const check::Predicate& p = of.predicate;
    const std::uint64_t frames = of.evidence.side(aim.of_positives).frames;
    const std::string all =
        counted(of.evidence.demonstrations, of.is_monitor ? "episode" : "demonstration");
    const char* const word = true_word(of, aim);
    const std::string at = counted(frames, of.unit());
    std::string message;
    if (frames == 0)
        message =
            fmt::format("{}'{}' is {} at no {} of {}, so there is nothing to learn its {} from",
                        of.is_monitor ? "the ground truth of " : "", p.name, word, of.unit(), all,
                        of.is_monitor ? "shift" : "threshold");
    else if (of.is_monitor)
        message = fmt::format(
            "whatever its shift, '{}' is {} at none of the {} at which its ground truth is {}, in "
            "{}",
            p.name, wrong_word(of, aim), at, word, all);
    else
        message = fmt::format("the distance of '{}' is unknown at all {} where it is {}, in {}",
                              p.name, at, word, all);
    auto& error = sink.report(diag::Code::no_positive_frame, p.threshold.span, std::move(message));
    note_open(of, error);
    for (const check::Truth& truth : model.truths)
        if (!of.is_monitor && &model.predicates[truth.predicate] == &p)
            error.note(truth.span, "its truth is here");
}

void refuse_too_few(const Subject& of, const Aim& aim, diag::Sink& sink) {
    const bool by_frame = of.predicate.threshold.origin == ThresholdOrigin::class_conditional;
    const Evidence::Side& side = of.evidence.side(aim.of_positives);
    const bool by_risk = of.predicate.threshold.origin == ThresholdOrigin::risk;
    const std::uint64_t scores = by_frame  ? side.reaches.size()
                                 : by_risk ? losses_beyond(side, 0, kAll).size()
                                           : side.worst.size();
    auto& error = sink.report(diag::Code::too_few_scores, of.predicate.threshold.span,
                              needed(of, aim, scores));
    if (by_frame) return;
    note_open(of, error);
    const std::uint64_t groups = of.evidence.groups;
    if (of.by_group)
        error.note(fmt::format(
            "{} are in {}, and the episodes of a group count once, with the worst of them",
            counted(of.evidence.demonstrations, of.is_monitor ? "episode" : "demonstration"),
            counted(groups, of.noun())));
    if (groups <= scores) return;
    error.note(fmt::format("of {}, {} without such a {} {} left out", counted(groups, of.noun()),
                           groups - scores, of.unit(), groups - scores == 1 ? "is" : "are"));
}

}  // namespace

std::string Subject::which(const Aim& aim) const {
    if (is_normal(predicate.threshold)) return "";
    return fmt::format(" in which {}'{}' is {} at some {}",
                       is_monitor ? "the ground truth of " : "", predicate.name,
                       true_word(*this, aim), unit());
}

void refuse(const check::Model& model, const Subject& of, const Aim& aim, Refusal refusal,
            diag::Sink& sink) {
    const check::Predicate& p = of.predicate;
    const auto report = [&](std::string message) {
        sink.report(diag::Code::no_threshold, p.threshold.span, std::move(message));
    };
    if (refusal == Refusal::no_positives || of.evidence.side(aim.of_positives).frames == 0)
        return refuse_without_case(model, of, aim, sink);
    switch (refusal) {
        case Refusal::too_few: return refuse_too_few(of, aim, sink);
        case Refusal::no_f1:
            return report(
                fmt::format("no observed value as threshold of '{}' finds a positive frame; it "
                            "has {}",
                            p.name, counted(of.evidence.positives.frames, "positive frame")));
        case Refusal::always_lost:
            return report(fmt::format(
                "whatever its threshold, '{}' is {} at too many of the {}s at which it is {}, "
                "because its samples are missing there: on average over the {}s more than {} = {} "
                "allows",
                p.name, wrong_word(of, aim), of.unit(), true_word(of, aim), of.noun(),
                aim.rate_name, aim.rate));
        default:
            if (of.is_monitor && is_normal(p.threshold)) {
                const std::vector<Evidence::Reach>& all = of.evidence.positives.worst;
                const auto never = std::count_if(all.begin(), all.end(), [](const auto& one) {
                    return one.reach < -std::numeric_limits<double>::max();
                });
                const auto always = std::count_if(all.begin(), all.end(), [](const auto& one) {
                    return one.reach > std::numeric_limits<double>::max();
                });
                return report(fmt::format(
                    "of {}, {} violate '{}' for good with every shift and {} with none, so no "
                    "shift "
                    "gives alpha = {}",
                    counted(all.size(), of.noun()), always, p.name, never, p.threshold.alpha));
            }
            return report(fmt::format(
                "the score of '{}' at the rank of {} = {} is infinite: no {} "
                "lies beyond it",
                p.name, aim.rate_name, aim.rate, of.is_monitor ? "shift" : "threshold"));
    }
}

void refuse_both(const Subject& of, diag::Sink& sink) {
    auto& error = sink.report(
        diag::Code::too_few_scores, of.predicate.threshold.span,
        fmt::format("'{}' would always be unknown: both its thresholds are infinite, because there "
                    "are too few {}s",
                    of.predicate.name, of.noun()));
    for (const Aim& aim : aims_of(of.predicate))
        error.note(needed(of, aim, of.evidence.side(aim.of_positives).worst.size()));
    note_open(of, error);
}

void warn_of_large_alpha(const check::Predicate& predicate, diag::Sink& sink) {
    using check::Decimal;
    for (const Aim& aim : aims_of(predicate)) {
        if (aim.rate.empty() || !(Decimal::parse("0.5") < Decimal::parse(aim.rate))) continue;
        episodes::warn_of_data(
            diag::Code::large_alpha,
            fmt::format("{} = {} of '{}' allows more than half to be {}", aim.rate_name, aim.rate,
                        predicate.name, aim.of_positives ? "missed" : "false positives"),
            predicate.threshold.span, sink)
            .note(check::large_alpha_note(aim.rate, aim.rate_name));
        return;
    }
}

void warn_of_doubts(const check::Predicate& predicate, const Evidence& evidence, float epsilon,
                    diag::Sink& sink) {
    constexpr double kNearlyEvery = 0.95;
    warn_of_large_alpha(predicate, sink);
    if (is_normal(predicate.threshold)) return;  // nothing says which frames are not
    const auto warn = [&](std::string message) -> diag::Diagnostic& {
        return episodes::warn_of_data(diag::Code::doubtful_threshold, std::move(message),
                                      predicate.threshold.span, sink);
    };
    const auto ranked = episodes::auroc(evidence.labelled, evidence.groups);
    if (episodes::warn_of_labels(predicate, {evidence.positives.frames, evidence.negatives.frames},
                                 ranked, sink))
        return;
    if (ranked.interval && ranked.interval->low <= 0.5) {
        warn(fmt::format("what '{}' measures does not tell its labels apart: the area under the "
                         "ROC curve is {:.2f}, with a 95 % interval from {:.2f} to {:.2f}",
                         predicate.name, *ranked.value, ranked.interval->low,
                         ranked.interval->high))
            .note("0.5 is chance: check the labels, the embedding and the targets");
        return;
    }
    if (predicate.threshold.against == check::Against::both) return;
    const bool wrongly = is_against(predicate.threshold, true);  // what it is not against
    const double part = wrong_part(predicate, evidence, epsilon, wrongly);
    if (part < kNearlyEvery) return;
    warn(fmt::format("with the threshold {:.9g}, '{}' is {} at {:.0f} % of the frames labelled {}",
                     epsilon, predicate.name, wrongly, std::floor(100 * part), !wrongly))
        .note("a weaker guarantee, more targets or other labels may make it narrower");
}

}  // namespace etlc::calibrate
