#include "calibrate/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "check/guarantees/adaptation.hpp"
#include "check/guarantees/conformal.hpp"
#include "episodes/folds.hpp"

namespace etlc::calibrate {

namespace {

using check::ThresholdOrigin;

constexpr std::uint32_t kNobody = UINT32_MAX;

/// Collects the thresholds; the first that is missing gives the reason.
class Collected {
public:
    Collected(std::string alpha, const char* each, std::size_t groups)
        : alpha_(std::move(alpha)), each_(each) {
        result_.thresholds.resize(groups);
    }

    /// Takes the threshold of one group.
    void take(const Fit& fit, std::uint32_t group) {
        if (const auto* fitted = std::get_if<Fitted>(&fit))
            result_.thresholds[group] = fitted->epsilon;
        else
            fail(fit);
    }
    /// Takes the threshold of the groups for which `has(g)` holds.
    template <class Has>
    void take_all(const Fit& fit, const Has& has) {
        for (std::uint32_t g = 0; g < result_.thresholds.size(); ++g)
            if (has(g)) take(fit, g);
    }
    LeftOut result() && {
        if (!result_.why.empty()) result_.thresholds.clear();
        return std::move(result_);
    }

private:
    void fail(const Fit& fit) {
        if (!result_.why.empty()) return;
        if (std::holds_alternative<OutOfRange>(fit))
            result_.why = "the threshold is out of its range";
        else if (std::get<Refusal>(fit) == Refusal::too_few)
            result_.why = fmt::format("too few are left for alpha = {}", alpha_);
        else if (std::get<Refusal>(fit) == Refusal::not_finite)
            result_.why = "the score at the rank is infinite";
        else
            result_.why = fmt::format("no {} is left", each_);
    }

    std::string alpha_;
    const char* each_;
    LeftOut result_;
};

/// Takes the thresholds by the rank of one score per group. All groups whose score is among the
/// best ones leave the same scores at the rank, and so do all others.
template <class FitWithout>
void take_by_rank(std::vector<Evidence::Reach> scores, const std::string& alpha, std::size_t groups,
                  const FitWithout& fit_without, Collected& collected) {
    std::sort(scores.begin(), scores.end());
    const std::uint64_t k = scores.empty() ? 0 : check::rank(alpha, scores.size() - 1);
    std::vector<std::uint8_t> classes(groups);  // 0: without a score, 1: among the best, 2: others
    for (std::size_t i = 0; i < scores.size(); ++i) classes[scores[i].group] = i < k ? 1 : 2;
    const std::uint32_t best = scores.empty() ? kNobody : scores.front().group;
    const std::uint32_t last = scores.empty() ? kNobody : scores.back().group;
    const std::uint32_t without[] = {kNobody, best, last};
    for (std::uint8_t c = 0; c < 3; ++c)
        if (std::find(classes.begin(), classes.end(), c) != classes.end())
            collected.take_all(fit_without(without[c]),
                               [&](std::uint32_t g) { return classes[g] == c; });
}

/// Takes the thresholds by the rank of one score per positive frame, in one pass over the scores.
void take_by_frames(const check::Predicate& predicate, const Evidence& evidence,
                    Collected& collected) {
    struct Group {
        std::uint64_t frames = 0;  ///< its own
        std::uint64_t before = 0;  ///< its own so far
        std::uint64_t k = 0;       ///< rank among the others
    };
    std::vector<Group> groups(evidence.groups);
    evidence.reaches.for_each([&](const Evidence::Reach& one) { ++groups[one.group].frames; });
    // The score of a group is the one at place k among the others, so at place k + `before` among
    // all. That place only grows, so a group is looked at when its last known place comes.
    using Place = std::pair<std::uint64_t, std::uint32_t>;
    std::priority_queue<Place, std::vector<Place>, std::greater<>> due;
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
        const std::uint64_t others = evidence.reaches.size() - groups[g].frames;
        if (others == 0) return collected.take(Refusal::no_positives, g);
        groups[g].k = check::rank(predicate.threshold.alpha, others);
        if (groups[g].k > others) return collected.take(Refusal::too_few, g);
        due.emplace(groups[g].k, g);
    }
    std::uint64_t place = 0;
    evidence.reaches.for_each([&](const Evidence::Reach& one) {
        ++place;
        ++groups[one.group].before;
        while (!due.empty() && due.top().first <= place) {
            const std::uint32_t g = due.top().second;
            due.pop();
            const std::uint64_t at = groups[g].k + groups[g].before;
            if (at > place) {
                due.emplace(at, g);
                continue;
            }
            Fit fit = fit_rank({one.reach}, "0.5");  // the threshold beyond this score
            if (auto* fitted = std::get_if<Fitted>(&fit)) mirror(*fitted, predicate.upper_bound());
            collected.take(fit, g);
        }
    });
}

}  // namespace

LeftOut left_out(const check::Predicate& predicate, const Evidence& evidence,
                 const episodes::Identities& demonstrations, const episodes::Groups& groups) {
    Collected collected(predicate.threshold.alpha, "positive frame", groups.count());
    const ThresholdOrigin origin = predicate.threshold.origin;
    if (origin == ThresholdOrigin::f1) {
        const std::uint32_t parts = std::min(groups.count(), kMostParts);
        const auto part_of = episodes::folds_of(demonstrations, groups, parts);
        auto fits = fit_f1_without(evidence.labelled, predicate.strict(), part_of, parts);
        for (std::uint32_t p = 0; p < parts; ++p) {
            if (auto* fitted = std::get_if<Fitted>(&fits[p]))
                mirror(*fitted, predicate.upper_bound());
            collected.take_all(fits[p], [&](std::uint32_t g) { return part_of[g] == p; });
        }
        LeftOut result = std::move(collected).result();
        result.parts = parts < groups.count() ? parts : 0;
        return result;
    }
    if (origin == ThresholdOrigin::class_conditional) {
        take_by_frames(predicate, evidence, collected);
        return std::move(collected).result();
    }
    const auto fit_without = [&](std::uint32_t one) {
        Fit found = fit(predicate, evidence, [&](std::uint32_t g) { return g != one; });
        auto* const fitted = std::get_if<Fitted>(&found);
        if (fitted != nullptr && predicate.threshold.adaptation)
            fitted->epsilon = *check::start(*predicate.threshold.adaptation, fitted->epsilon,
                                            predicate.upper_bound());
        return found;
    };
    take_by_rank(evidence.worst, predicate.threshold.alpha, groups.count(), fit_without, collected);
    return std::move(collected).result();
}

LeftOut left_out(const check::MonitorCalibration& calibration,
                 const std::vector<Evidence::Reach>& worst, std::size_t groups) {
    const std::string& alpha = calibration.threshold.alpha;
    Collected collected(alpha, "step that counts", groups);
    const auto fit_without = [&](std::uint32_t one) {
        std::vector<double> others;
        for (const auto& [score, group] : worst)
            if (group != one) others.push_back(score);
        Fit fit = fit_rank(std::move(others), alpha);
        if (auto* fitted = std::get_if<Fitted>(&fit))
            mirror(*fitted, calibration.against == check::Against::missed_alarm);
        return fit;
    };
    take_by_rank(worst, alpha, groups, fit_without, collected);
    return std::move(collected).result();
}

}  // namespace etlc::calibrate
