#include "calibrate/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "episodes/folds.hpp"

namespace etlc::calibrate {

namespace {

using check::ThresholdOrigin;

/// Half of F1: true positives / (positives + claims), compared without rounding.
struct HalfF1 {
    std::uint64_t true_positives = 0;
    std::uint64_t of = 1;

    double value() const {
        return 2 * static_cast<double>(true_positives) / static_cast<double>(of);
    }
    /// There are fewer than 2^32 frames, so the products fit.
    bool operator<(const HalfF1& other) const {
        return true_positives * other.of < other.true_positives * of;
    }
};

/// Finds the score that is the best epsilon, from the scores of labelled frames in ascending order.
class BestF1 {
public:
    BestF1(std::uint64_t positives, bool strict) : positives_(positives), strict_(strict) {}

    /// Adds the next score and the numbers of frames that have it.
    void add(float score, std::uint64_t positives, std::uint64_t negatives) {
        if (is_best_ && !strict_ && !std::isinf(score)) other_ = score;
        is_best_ = false;
        const HalfF1 below{true_positives_, positives_ + frames_};
        true_positives_ += positives;
        frames_ += positives + negatives;
        const HalfF1 here = strict_ ? below : HalfF1{true_positives_, positives_ + frames_};
        // The first of equals is the strictest.
        if (!std::isinf(score) && best_ < here) {
            best_ = here;
            taken_ = score;
            is_best_ = true;
            other_ = strict_ ? before_ : std::nullopt;
        }
        before_ = std::isinf(score) ? std::nullopt : std::optional(score);
    }

    const HalfF1& best() const { return best_; }
    std::uint64_t frames() const { return frames_; }
    /// Returns the scores, ascending, between which epsilon makes the same claims: the one taken,
    /// and the next above it (for <=) or below it (for <) if that is finite.
    std::vector<float> gap() const {
        if (!other_) return {taken_};
        return strict_ ? std::vector{*other_, taken_} : std::vector{taken_, *other_};
    }
    float taken() const { return taken_; }

private:
    std::uint64_t positives_;
    bool strict_;
    std::uint64_t true_positives_ = 0;
    std::uint64_t frames_ = 0;
    HalfF1 best_;
    float taken_ = 0;
    bool is_best_ = false;  ///< the previous score is the best so far
    std::optional<float> before_;
    std::optional<float> other_;
};

/// Fits a threshold to labelled frames, which are added in the order of their scores.
class F1Fit {
public:
    F1Fit(std::uint64_t positives, bool strict)
        : has_positives_(positives > 0), best_(positives, strict) {}

    void add(const episodes::Scored& frame) {
        if (frame.score != score_) end_tie();
        score_ = frame.score;
        ++(frame.positive ? positives_ : negatives_);
    }
    /// Returns the fit to all frames.
    Fit result() {
        end_tie();
        if (!has_positives_) return Refusal::no_positives;
        if (best_.best().true_positives == 0) return Refusal::no_f1;
        Fitted result;
        result.n = best_.frames();
        result.f1 = best_.best().value();
        result.epsilon = best_.taken();
        const std::vector<float> ends = best_.gap();
        result.scores = {static_cast<double>(result.epsilon)};
        const auto between = ends.size() == 2 ? check::halfway(ends[0], ends[1]) : std::nullopt;
        if (!between) return result;
        result.epsilon = *between;
        result.scores.assign(ends.begin(), ends.end());
        return result;
    }

private:
    void end_tie() {
        if (positives_ + negatives_ > 0) best_.add(score_, positives_, negatives_);
        positives_ = negatives_ = 0;
    }

    bool has_positives_;
    BestF1 best_;
    float score_ = 0;  ///< of the frames that are not yet counted
    std::uint64_t positives_ = 0;
    std::uint64_t negatives_ = 0;
};

/// Fits a threshold beyond the score at the rank of alpha; `kth(k)` returns the k-th smallest of n.
template <class Kth>
Fit ranked(std::uint64_t n, const std::string& alpha, const Kth& kth) {
    Fitted result;
    result.n = n;
    if (n == 0) return Refusal::no_positives;
    result.k = check::rank(alpha, n);
    if (result.k > n) return Refusal::too_few;
    const double score = kth(result.k);
    if (std::isinf(score)) return Refusal::not_finite;
    result.epsilon = check::strictly_above(score);
    result.scores = {score};
    if (std::isinf(result.epsilon)) return Refusal::not_finite;
    return result;
}

/// Fits a threshold to all positive frames.
Fit fit_pooled(const data::Sorted<Evidence::Reach>& reaches, const std::string& alpha,
               const Counts& counts) {
    std::uint64_t n = 0;
    reaches.for_each([&](const Evidence::Reach& one) { n += counts(one.group) ? 1 : 0; });
    return ranked(n, alpha, [&](std::uint64_t k) {
        double found = 0;
        reaches.for_each([&](const Evidence::Reach& one) {
            if (k > 0 && counts(one.group) && --k == 0) found = one.reach;
        });
        return found;
    });
}

}  // namespace

thresholds::Entry entry_of(const check::Threshold& threshold, const Fitted& fitted,
                           check::Reads reads) {
    thresholds::Entry entry;
    entry.method = check::method_name(threshold.origin);
    entry.alpha = threshold.alpha;
    entry.epsilon = fitted.epsilon;
    entry.n = fitted.n;
    entry.k = fitted.k;
    entry.scores = fitted.scores;
    entry.reads = std::move(reads);
    return entry;
}

std::string describe_place(const Fitted& fitted, bool upper_bound, const std::string& each) {
    const std::uint64_t last = fitted.k % 10;
    const bool teen = fitted.k / 10 % 10 == 1;
    const char* const ending = teen        ? "th"
                               : last == 1 ? "st"
                               : last == 2 ? "nd"
                               : last == 3 ? "rd"
                                           : "th";
    return fmt::format("just {} the {}{} {} of {}, one per {}", upper_bound ? "above" : "below",
                       fitted.k, ending, upper_bound ? "smallest" : "greatest",
                       diag::counted(fitted.n, "score"), each);
}

void mirror(Fitted& fitted, bool upper_bound) {
    if (!upper_bound) {
        fitted.epsilon = 0.0F - fitted.epsilon;  // 0 rather than -0
        for (double& score : fitted.scores) score = 0.0 - score;
    }
    std::sort(fitted.scores.begin(), fitted.scores.end());
}

Fit fit_rank(std::vector<double> reaches, const std::string& alpha) {
    return ranked(reaches.size(), alpha, [&](std::uint64_t k) {
        const auto kth = reaches.begin() + static_cast<std::ptrdiff_t>(k - 1);
        std::nth_element(reaches.begin(), kth, reaches.end());
        return *kth;
    });
}

Fit fit_f1(const episodes::FramesByScore& labelled, bool strict, const Counts& counts) {
    std::uint64_t positives = 0;
    labelled.for_each([&](const episodes::Scored& frame) {
        positives += frame.positive && counts(frame.episode) ? 1 : 0;
    });
    F1Fit fit(positives, strict);
    labelled.for_each([&](const episodes::Scored& frame) {
        if (counts(frame.episode)) fit.add(frame);
    });
    return fit.result();
}

std::vector<Fit> fit_f1_without(const episodes::FramesByScore& labelled, bool strict,
                                const std::vector<std::uint32_t>& part_of, std::uint32_t parts) {
    std::vector<std::uint64_t> positives(parts, labelled.positives());
    labelled.for_each([&](const episodes::Scored& frame) {
        positives[part_of[frame.episode]] -= frame.positive ? 1 : 0;
    });
    std::vector<F1Fit> fits;
    for (std::uint32_t p = 0; p < parts; ++p) fits.emplace_back(positives[p], strict);
    labelled.for_each([&](const episodes::Scored& frame) {
        for (std::uint32_t p = 0; p < parts; ++p)
            if (p != part_of[frame.episode]) fits[p].add(frame);
    });
    std::vector<Fit> results;
    for (F1Fit& fit : fits) results.push_back(fit.result());
    return results;
}

Fit fit(const check::Predicate& predicate, const Evidence& evidence, const Counts& counts) {
    const check::Threshold& threshold = predicate.threshold;
    std::vector<double> by_group;
    const auto by_worst = [&] {
        for (const auto& [reach, group] : evidence.worst)
            if (counts(group)) by_group.push_back(reach);
        return fit_rank(by_group, threshold.alpha);
    };
    Fit fit = threshold.origin == ThresholdOrigin::f1
                  ? fit_f1(evidence.labelled, predicate.strict(), counts)
              : threshold.origin == ThresholdOrigin::class_conditional
                  ? fit_pooled(evidence.reaches, threshold.alpha, counts)
                  : by_worst();
    if (auto* fitted = std::get_if<Fitted>(&fit)) {
        if (!by_group.empty()) fitted->scores = std::move(by_group);
        mirror(*fitted, predicate.upper_bound());
        const auto& adaptation = threshold.adaptation;
        if (adaptation && !check::start(*adaptation, fitted->epsilon, predicate.upper_bound()))
            return OutOfRange{fitted->epsilon};
    }
    return fit;
}

// ---- without each group -------------------------------------------------------------------------

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
