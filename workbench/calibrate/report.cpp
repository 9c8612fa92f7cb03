// The report that `etlc calibrate` prints.
#include <fmt/format.h>

#include <algorithm>

#include "calibrate/calibrate.hpp"
#include "check/guarantees/guarantees.hpp"

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

}  // namespace etlc::calibrate
