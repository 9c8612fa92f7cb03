#include "calibrate/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>

#include "check/guarantees/calibrated.hpp"

namespace etlc::calibrate {

namespace {

using check::ThresholdOrigin;

/// Half of F1: true positives / (positives + predictions), compared without rounding.
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

/// Finds the score that is the best epsilon. Labelled frames are added in the order of their
/// scores.
class F1Fit {
public:
    F1Fit(std::uint64_t positives, bool strict) : positives_(positives), strict_(strict) {}

    void add(const episodes::Scored& frame) {
        if (frame.score != score_) end_tie();
        score_ = frame.score;
        ++(frame.positive ? tied_positives_ : tied_negatives_);
    }
    /// Returns the fit to all frames.
    Fit result() {
        end_tie();
        if (positives_ == 0) return Refusal::no_positives;
        if (best_.true_positives == 0) return Refusal::no_f1;
        Fitted result;
        result.n = frames_;
        result.f1 = best_.value();
        result.epsilon = taken_;
        result.scores = {static_cast<double>(taken_)};
        if (!other_) return result;
        const auto [low, high] = std::minmax(taken_, *other_);
        const auto between = check::halfway(low, high);
        if (!between) return result;
        result.epsilon = *between;
        result.scores = {static_cast<double>(low), static_cast<double>(high)};
        return result;
    }

private:
    /// Considers the score of the frames that are not yet counted.
    void end_tie() {
        if (tied_positives_ + tied_negatives_ == 0) return;
        const bool is_finite = !std::isinf(score_);
        if (is_best_ && !strict_ && is_finite) other_ = score_;
        is_best_ = false;
        const HalfF1 below{true_positives_, positives_ + frames_};
        true_positives_ += tied_positives_;
        frames_ += tied_positives_ + tied_negatives_;
        tied_positives_ = tied_negatives_ = 0;
        const HalfF1 here = strict_ ? below : HalfF1{true_positives_, positives_ + frames_};
        // The first of equals is the strictest.
        if (is_finite && best_ < here) {
            best_ = here;
            taken_ = score_;
            is_best_ = true;
            other_ = strict_ ? before_ : std::nullopt;
        }
        before_ = is_finite ? std::optional(score_) : std::nullopt;
    }

    std::uint64_t positives_;
    bool strict_;
    float score_ = 0;  ///< of the frames that are not yet counted
    std::uint64_t tied_positives_ = 0;
    std::uint64_t tied_negatives_ = 0;
    std::uint64_t true_positives_ = 0;
    std::uint64_t frames_ = 0;
    HalfF1 best_;
    float taken_ = 0;
    bool is_best_ = false;         ///< the previous score is the best so far
    std::optional<float> before_;  ///< the previous score if it is finite
    /// The score next to the one taken, if it is finite: epsilon makes the same predictions
    /// everywhere between them. It lies above (for <=) or below (for <).
    std::optional<float> other_;
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

/// Returns the score of the i-th frame of groups that count; infinite beyond the last.
double score_at(const Evidence::Side& side, std::uint64_t i, const Counts& counts) {
    double found = std::numeric_limits<double>::infinity();
    std::uint64_t place = 0;
    side.reaches.for_each([&](const Evidence::Reach& one) {
        if (counts(one.group) && place++ == i) found = one.reach;
    });
    return found;
}

/// Fits the tightest threshold that keeps the expected loss of a new group.
Fit fit_risk(const Evidence::Side& side, const std::string& rate, const Counts& counts) {
    std::uint64_t scores = 0;
    side.reaches.for_each([&](const Evidence::Reach& one) { scores += counts(one.group) ? 1 : 0; });
    Fitted result;
    result.losses =
        losses_beyond(side, std::numeric_limits<double>::infinity(), counts);  // of the loosest
    result.n = result.losses.size();
    if (!check::keeps_risk(std::vector<double>(result.n), rate)) return Refusal::too_few;
    if (!check::keeps_risk(result.losses, rate)) return Refusal::always_lost;
    if (scores == 0) return Refusal::no_positives;
    std::uint64_t least = 0;
    std::uint64_t kept = scores - 1;
    while (least < kept) {
        const std::uint64_t middle = least + (kept - least) / 2;
        if (check::keeps_risk(losses_beyond(side, score_at(side, middle, counts), counts), rate))
            kept = middle;
        else
            least = middle + 1;
    }
    const double score = score_at(side, least, counts);
    result.epsilon = check::strictly_above(score);
    if (std::isinf(score) || std::isinf(result.epsilon)) return Refusal::not_finite;
    result.scores = {score};
    result.losses = losses_beyond(side, score, counts);
    if (least > 0)
        result.losses_before = losses_beyond(side, score_at(side, least - 1, counts), counts);
    return result;
}

/// Returns the threshold against both errors of a side with too few scores.
Fitted without_end(const Evidence::Side& side, bool by_risk, std::vector<double> scores,
                   const Counts& counts) {
    Fitted result;
    result.epsilon = std::numeric_limits<float>::infinity();
    if (by_risk)
        result.losses = losses_beyond(side, std::numeric_limits<double>::infinity(), counts);
    result.n = by_risk ? result.losses.size() : scores.size();
    result.k = by_risk ? 0 : result.n + 1;
    result.scores = std::move(scores);
    return result;
}

}  // namespace

std::vector<Aim> aims_of(const check::Predicate& predicate) {
    const check::Threshold& threshold = predicate.threshold;
    std::vector<Aim> aims;
    for (const bool of_positives : {true, false}) {
        if (!is_against(threshold, of_positives)) continue;
        const bool is_beta = !of_positives && !threshold.beta.empty();
        aims.push_back({of_positives, of_positives == predicate.upper_bound(),
                        is_beta ? threshold.beta : threshold.alpha, is_beta ? "beta" : "alpha"});
    }
    return aims;
}

check::Predicate over_robustness(const check::Monitor& monitor) {
    check::Predicate predicate;
    predicate.name = monitor.name;
    predicate.comparison = check::Comparison::greater_equal;
    predicate.threshold = *monitor.calibration;
    return predicate;
}

check::Both joined(const check::Predicate& predicate, const Sides& sides) {
    if (sides.size() == 1) return {sides[0].epsilon, std::nullopt};
    return check::both(sides[0].epsilon, sides[1].epsilon, predicate.upper_bound());
}

void set(check::Threshold& threshold, const check::Predicate& predicate, const Sides& sides) {
    const check::Both both = joined(predicate, sides);
    threshold.value = both.value;
    threshold.inner = both.inner;
    threshold.n = sides[0].n;
    threshold.k = sides[0].k;
    if (sides.size() == 1) return;
    threshold.inner_n = sides[1].n;
    threshold.inner_k = sides[1].k;
}

std::vector<double> losses_beyond(const Evidence::Side& side, double lambda, const Counts& counts) {
    std::vector<std::uint64_t> lost;
    for (const Evidence::Episode& episode : side.episodes) lost.push_back(episode.lost);
    side.reaches.for_each([&](const Evidence::Reach& one) {
        if (one.reach > lambda) ++lost[one.episode];
    });
    std::map<std::uint32_t, double> worst;  // by group
    for (std::size_t e = 0; e < side.episodes.size(); ++e) {
        const Evidence::Episode& episode = side.episodes[e];
        if (!counts(episode.group)) continue;
        double& loss = worst[episode.group];
        loss = std::max(loss, static_cast<double>(lost[e]) / static_cast<double>(episode.frames));
    }
    std::vector<double> losses;
    for (const auto& [group, loss] : worst) losses.push_back(loss);
    return losses;
}

thresholds::Entry entry_of(const check::Threshold& threshold, const Sides& sides,
                           check::Reads reads) {
    thresholds::Entry entry;
    entry.method = check::method_name(threshold.origin);
    entry.alpha = threshold.alpha;
    entry.beta = threshold.beta;
    entry.within = threshold.within;
    if (threshold.against != check::Against::misses) entry.against = check::word(threshold.against);
    static_cast<thresholds::Side&>(entry) = sides[0];
    if (sides.size() > 1) entry.inner = sides[1];
    entry.reads = std::move(reads);
    return entry;
}

std::string describe_place(const Fitted& fitted, bool above, const std::string& each) {
    const std::uint64_t last = fitted.k % 10;
    const bool teen = fitted.k / 10 % 10 == 1;
    const char* const ending = teen        ? "th"
                               : last == 1 ? "st"
                               : last == 2 ? "nd"
                               : last == 3 ? "rd"
                                           : "th";
    return fmt::format("just {} the {}{} {} of {}, one per {}", above ? "above" : "below", fitted.k,
                       ending, above ? "smallest" : "greatest", diag::counted(fitted.n, "score"),
                       each);
}

void mirror(Fitted& fitted, bool above) {
    if (!above) {
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

Fit fit(const check::Predicate& predicate, const Aim& aim, const Evidence& evidence,
        const Counts& counts) {
    const check::Threshold& threshold = predicate.threshold;
    const Evidence::Side& side = evidence.side(aim.of_positives);
    const bool by_risk = threshold.origin == ThresholdOrigin::risk;
    std::vector<double> by_group;
    const auto by_worst = [&] {
        for (const Evidence::Reach& worst : side.worst)
            if (counts(worst.group)) by_group.push_back(worst.reach);
        return fit_rank(by_group, aim.rate);
    };
    Fit fit = threshold.origin == ThresholdOrigin::f1
                  ? fit_f1(evidence.labelled, predicate.strict(), counts)
              : threshold.origin == ThresholdOrigin::class_conditional
                  ? fit_pooled(side.reaches, aim.rate, counts)
              : by_risk ? fit_risk(side, aim.rate, counts)
                        : by_worst();
    const auto* const refusal = std::get_if<Refusal>(&fit);
    // A missing sample that counts as the error loses it whatever the threshold.
    const bool may_lose = by_risk && predicate.missing && *predicate.missing != aim.of_positives;
    const bool is_short = refusal != nullptr && (*refusal == Refusal::too_few ||
                                                 (*refusal == Refusal::no_positives && !by_risk));
    if (threshold.against == check::Against::both && is_short && !may_lose)
        fit = without_end(side, by_risk, by_group, counts);
    if (auto* fitted = std::get_if<Fitted>(&fit)) {
        if (!by_group.empty()) fitted->scores = std::move(by_group);
        mirror(*fitted, aim.above);
        const auto& adaptation = threshold.adaptation;
        if (adaptation && !check::start(*adaptation, fitted->epsilon, predicate.upper_bound()))
            return OutOfRange{fitted->epsilon};
    }
    return fit;
}

// ---- without each group -------------------------------------------------------------------------

namespace {

constexpr std::uint32_t kNobody = UINT32_MAX;

/// The thresholds for one error without each group; the first that is missing gives the reason.
struct OneSide {
    const Aim& aim;
    bool may_be_infinite = false;   ///< all groups together have too few scores
    std::vector<float> thresholds;  ///< per group
    std::string why{};              ///< why one is missing

    /// Takes the threshold of one group.
    void take(const Fit& fit, std::uint32_t group) {
        const auto* const fitted = std::get_if<Fitted>(&fit);
        if (fitted == nullptr)
            fail(fit);
        else if (std::isinf(fitted->epsilon) && !may_be_infinite)
            fail(Refusal::too_few);
        else
            thresholds[group] = fitted->epsilon;
    }
    /// Takes the threshold of the groups for which `has(g)` holds.
    template <class Has>
    void take_all(const Fit& fit, const Has& has) {
        for (std::uint32_t g = 0; g < thresholds.size(); ++g)
            if (has(g)) take(fit, g);
    }

private:
    void fail(const Fit& fit) {
        if (!why.empty()) return;
        if (std::holds_alternative<OutOfRange>(fit))
            why = "the threshold is out of its range";
        else if (std::get<Refusal>(fit) == Refusal::too_few)
            why = fmt::format("too few are left for {} = {}", aim.rate_name, aim.rate);
        else if (std::get<Refusal>(fit) == Refusal::always_lost)
            why = "missing samples alone lose too much";
        else if (std::get<Refusal>(fit) == Refusal::not_finite)
            why = "the score at the rank is infinite";
        else
            why = fmt::format("no {} frame is left", aim.of_positives ? "positive" : "negative");
    }
};

/// Takes the thresholds by the rank of one score per group. All groups whose score is among the
/// best ones leave the same scores at the rank, and so do all others.
template <class FitWithout>
void take_by_rank(std::vector<Evidence::Reach> scores, const std::string& rate, std::size_t groups,
                  const FitWithout& fit_without, OneSide& side) {
    std::sort(scores.begin(), scores.end());
    const std::uint64_t k = scores.empty() ? 0 : check::rank(rate, scores.size() - 1);
    std::vector<std::uint8_t> classes(groups);  // 0: without a score, 1: among the best, 2: others
    for (std::size_t i = 0; i < scores.size(); ++i) classes[scores[i].group] = i < k ? 1 : 2;
    const std::uint32_t best = scores.empty() ? kNobody : scores.front().group;
    const std::uint32_t last = scores.empty() ? kNobody : scores.back().group;
    const std::uint32_t without[] = {kNobody, best, last};
    for (std::uint8_t c = 0; c < 3; ++c)
        if (std::find(classes.begin(), classes.end(), c) != classes.end())
            side.take_all(fit_without(without[c]),
                          [&](std::uint32_t g) { return classes[g] == c; });
}

/// Takes the thresholds by the rank of one score per positive frame, in one pass over the scores.
void take_by_frames(const check::Predicate& predicate, const Evidence& evidence, OneSide& side) {
    struct Group {
        std::uint64_t frames = 0;  ///< its own
        std::uint64_t before = 0;  ///< its own so far
        std::uint64_t k = 0;       ///< rank among the others
    };
    std::vector<Group> groups(evidence.groups);
    const data::Sorted<Evidence::Reach>& reaches = evidence.positives.reaches;
    reaches.for_each([&](const Evidence::Reach& one) { ++groups[one.group].frames; });
    // The score of a group is the one at place k among the others, so at place k + `before` among
    // all. That place only grows, so a group is looked at when its last known place comes.
    using Place = std::pair<std::uint64_t, std::uint32_t>;
    std::priority_queue<Place, std::vector<Place>, std::greater<>> due;
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
        const std::uint64_t others = reaches.size() - groups[g].frames;
        if (others == 0) return side.take(Refusal::no_positives, g);
        groups[g].k = check::rank(predicate.threshold.alpha, others);
        if (groups[g].k > others) return side.take(Refusal::too_few, g);
        due.emplace(groups[g].k, g);
    }
    std::uint64_t place = 0;
    reaches.for_each([&](const Evidence::Reach& one) {
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
            side.take(fit, g);
        }
    });
}

/// Takes the thresholds without each of as many parts of the groups.
void take_by_parts(const check::Predicate& predicate, const Aim& aim, const Evidence& evidence,
                   const std::vector<std::uint32_t>& part_of, std::uint32_t parts, OneSide& side) {
    std::vector<Fit> fits;
    if (predicate.threshold.origin == ThresholdOrigin::f1) {
        fits = fit_f1_without(evidence.labelled, predicate.strict(), part_of, parts);
        for (Fit& one : fits)
            if (auto* fitted = std::get_if<Fitted>(&one)) mirror(*fitted, aim.above);
    }
    for (std::uint32_t p = static_cast<std::uint32_t>(fits.size()); p < parts; ++p)
        fits.push_back(
            fit(predicate, aim, evidence, [&](std::uint32_t g) { return part_of[g] != p; }));
    for (std::uint32_t p = 0; p < parts; ++p)
        side.take_all(fits[p], [&](std::uint32_t g) { return part_of[g] == p; });
}

}  // namespace

LeftOut left_out(const check::Predicate& predicate, const Evidence& evidence,
                 const episodes::Identities& demonstrations, const episodes::Groups& groups) {
    const ThresholdOrigin origin = predicate.threshold.origin;
    const bool by_parts = origin == ThresholdOrigin::f1 || origin == ThresholdOrigin::risk;
    const std::uint32_t parts = std::min(groups.count(), kMostParts);
    LeftOut result;
    result.parts = by_parts && parts < groups.count() ? parts : 0;
    std::vector<OneSide> sides;
    const std::vector<Aim> aims = aims_of(predicate);
    for (const Aim& aim : aims) {
        const Fit whole = fit(predicate, aim, evidence);
        const auto* const of_all = std::get_if<Fitted>(&whole);
        sides.push_back({aim, of_all != nullptr && std::isinf(of_all->epsilon),
                         std::vector<float>(groups.count())});
        OneSide& side = sides.back();
        const auto fit_without = [&](std::uint32_t one) {
            Fit found = fit(predicate, aim, evidence, [&](std::uint32_t g) { return g != one; });
            auto* const fitted = std::get_if<Fitted>(&found);
            if (fitted != nullptr && predicate.threshold.adaptation)
                fitted->epsilon = *check::start(*predicate.threshold.adaptation, fitted->epsilon,
                                                predicate.upper_bound());
            return found;
        };
        if (by_parts)
            take_by_parts(predicate, aim, evidence,
                          episodes::folds_of(demonstrations, groups, parts), parts, side);
        else if (origin == ThresholdOrigin::class_conditional)
            take_by_frames(predicate, evidence, side);
        else
            take_by_rank(evidence.side(aim.of_positives).worst, aim.rate, groups.count(),
                         fit_without, side);
        if (result.why.empty()) result.why = side.why;
    }
    for (std::uint32_t g = 0; result.why.empty() && g < groups.count(); ++g) {
        Sides one;
        for (const OneSide& side : sides) one.emplace_back().epsilon = side.thresholds[g];
        result.thresholds.push_back(joined(predicate, one));
    }
    return result;
}

}  // namespace etlc::calibrate
