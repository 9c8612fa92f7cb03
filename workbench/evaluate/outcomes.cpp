#include "evaluate/outcomes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "episodes/ranking/auroc.hpp"

namespace etlc::evaluate {

namespace {

using Optional = std::optional<double>;

/// Returns successes or failures with an alarm, and all of them.
template <class Alarm>
std::vector<Fraction> alarms_in(const std::vector<Judged>& episodes, bool failures,
                                const Alarm& has_alarm) {
    std::vector<Fraction> result;
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        const bool counts = failures ? episodes[e].failed() : episodes[e].succeeded();
        result.push_back({counts && has_alarm(e) ? 1 : 0, counts ? std::uint64_t{1} : 0});
    }
    return result;
}

Optional balanced(const Optional& false_alarms, const Optional& detected) {
    if (!false_alarms || !detected) return std::nullopt;
    return (1 - *false_alarms + *detected) / 2;
}

Fraction sum(const std::vector<Fraction>& all) {
    Fraction result;
    for (const Fraction& one : all) {
        result.part += one.part;
        result.whole += one.whole;
    }
    return result;
}

/// Returns the share with its interval. Resampled groups say nothing where all or none count.
Figure rate(const Bootstrap& bootstrap, const std::vector<Judged>& episodes,
            const std::vector<Fraction>& each, bool by_group) {
    const Fraction all = sum(each);
    if (all.whole == 0) return {};
    const auto part = static_cast<std::uint64_t>(all.part);
    if (by_group && part > 0 && part < all.whole) return share(bootstrap, each);
    std::set<std::uint32_t> groups;
    for (std::size_t e = 0; e < each.size(); ++e)
        if (each[e].whole > 0) groups.insert(episodes[e].group);
    return {static_cast<double>(part) / static_cast<double>(all.whole),
            wilson(part == 0  ? 0
                   : by_group ? groups.size()
                              : part,
                   by_group ? groups.size() : all.whole)};
}

template <class Alarm>
DetectionRates<Optional> rates_of(const std::vector<Judged>& episodes, const Alarm& has_alarm) {
    const auto share_of = [&](bool failures) -> Optional {
        const Fraction all = sum(alarms_in(episodes, failures, has_alarm));
        if (all.whole == 0) return std::nullopt;
        return static_cast<double>(all.part) / static_cast<double>(all.whole);
    };
    const Optional false_alarms = share_of(false);
    const Optional detected = share_of(true);
    return {false_alarms, detected, balanced(false_alarms, detected)};
}

/// Returns the steps from the alarm to the failure.
std::int64_t warning_of(const Judged& episode) {
    const std::uint64_t end =
        episode.outcome.failed_at > 0 ? episode.outcome.failed_at : episode.frames - 1;
    return static_cast<std::int64_t>(end) - static_cast<std::int64_t>(*episode.alarm);
}

/// Returns a quantile of the warnings: `quarters` of 4 are at or below it.
Figure warning(const Bootstrap& bootstrap, const std::vector<Judged>& episodes,
               std::uint64_t quarters) {
    std::vector<std::pair<std::int64_t, std::size_t>> sorted;
    for (std::size_t e = 0; e < episodes.size(); ++e)
        if (episodes[e].failed() && episodes[e].alarm)
            sorted.emplace_back(warning_of(episodes[e]), e);
    std::sort(sorted.begin(), sorted.end());
    return bootstrap.figure([&](const Weights& weights) {
        std::vector<Optional> found(weights.resamples());
        for (std::size_t r = 0; r < weights.resamples(); ++r) {
            std::uint64_t all = 0;
            for (const auto& [steps, e] : sorted) all += weights[e][r];
            std::uint64_t below = 0;
            for (const auto& [steps, e] : sorted) {
                below += weights[e][r];
                if (weights[e][r] == 0 || 4 * below < quarters * all) continue;
                found[r] = static_cast<double>(steps);
                break;
            }
        }
        return found;
    });
}

}  // namespace

Interval wilson(std::uint64_t part, std::uint64_t whole) {
    constexpr double kZ = 1.959963984540054;
    const auto n = static_cast<double>(whole);
    const double p = static_cast<double>(part) / n;
    const double middle = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
    const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
    return {part == 0 ? 0 : middle - half, part == whole ? 1 : middle + half};
}

std::vector<bool> alarms_by_duration(const std::vector<Judged>& episodes) {
    std::map<std::uint64_t, std::size_t> places;
    for (const Judged& one : episodes) places.emplace(one.frames, 0);
    std::size_t next = 0;
    for (auto& [length, place] : places) place = next++;
    struct Counted {
        std::int64_t failures = 0;
        std::int64_t successes = 0;
    };
    std::vector<Counted> lengths(places.size());
    Counted all;
    const auto add = [&](const Judged& one, std::int64_t times) {
        for (Counted* const count : {&lengths[places.at(one.frames)], &all}) {
            count->failures += one.failed() ? times : 0;
            count->successes += one.succeeded() ? times : 0;
        }
    };
    for (const Judged& one : episodes) add(one, 1);
    std::map<std::pair<std::size_t, bool>, bool> known;
    std::vector<bool> alarms;
    for (const Judged& one : episodes) {
        if (!one.failed() && !one.succeeded()) {
            alarms.push_back(false);
            continue;
        }
        const std::size_t place = places.at(one.frames);
        const auto [found, is_new] = known.try_emplace({place, one.failed()});
        if (is_new) {
            add(one, -1);
            const auto best = greatest_stretch<std::int64_t>(lengths.size(), [&](std::size_t k) {
                return lengths[k].failures * all.successes - lengths[k].successes * all.failures;
            });
            add(one, 1);
            found->second = best && best->first <= place && place < best->end;
        }
        alarms.push_back(found->second);
    }
    return alarms;
}

std::optional<OutcomeScore> outcome_score(const Bootstrap& bootstrap,
                                          const std::vector<Judged>& episodes, bool by_group) {
    const auto has_alarm = [&](std::size_t e) { return episodes[e].alarm.has_value(); };
    const std::vector<Fraction> of_successes = alarms_in(episodes, false, has_alarm);
    const std::vector<Fraction> of_failures = alarms_in(episodes, true, has_alarm);
    OutcomeScore result;
    result.successes = sum(of_successes).whole;
    result.failures = sum(of_failures).whole;
    if (result.successes + result.failures == 0) return std::nullopt;
    result.false_alarm_count = static_cast<std::uint64_t>(sum(of_successes).part);
    result.detected_count = static_cast<std::uint64_t>(sum(of_failures).part);
    result.false_alarms = rate(bootstrap, episodes, of_successes, by_group);
    result.detected = rate(bootstrap, episodes, of_failures, by_group);
    result.balanced_accuracy = bootstrap.figure([&](const Weights& weights) {
        std::vector<Optional> values = episodes::shares(of_successes, weights);
        const std::vector<Optional> detected = episodes::shares(of_failures, weights);
        for (std::size_t r = 0; r < values.size(); ++r)
            values[r] = balanced(values[r], detected[r]);
        return values;
    });
    std::uint32_t folds = 0;
    for (const Judged& one : episodes) folds = std::max(folds, one.fold + 1);
    std::vector<episodes::FramesByScore> scores(folds);
    for (std::uint32_t e = 0; e < episodes.size(); ++e)
        if (episodes[e].succeeded() || episodes[e].failed())
            scores[episodes[e].fold].add({-episodes[e].least_upper, e, episodes[e].failed()});
    result.auroc =
        bootstrap.figure([&](const Weights& weights) { return episodes::auroc(scores, weights); });
    result.warning_lower_quartile = warning(bootstrap, episodes, 1);
    result.warning_median = warning(bootstrap, episodes, 2);
    result.warning_upper_quartile = warning(bootstrap, episodes, 3);
    const std::vector<bool> by_duration = alarms_by_duration(episodes);
    result.baselines = {
        {"always", rates_of(episodes, [](std::size_t) { return true; })},
        {"never", rates_of(episodes, [](std::size_t) { return false; })},
        {"duration", rates_of(episodes, [&](std::size_t e) { return by_duration[e]; })}};
    return result;
}

}  // namespace etlc::evaluate
