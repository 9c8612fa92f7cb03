#include "calibrate/other_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/guarantees/provenance.hpp"
#include "episodes/data_warnings.hpp"

namespace etlc::calibrate {

namespace {

using check::Claim;
using diag::counted;
using episodes::Fraction;

/// Counts of an episode, for intervals.
using Fractions = std::vector<Fraction>;

bool misses_success(const Guaranteed& of) {
    return of.claim.kind == Claim::Kind::missed_success;
}

/// Returns the verdict of the other error, and that of its truth.
const char* said_word(const Guaranteed& of) {
    return misses_success(of) ? "satisfied" : "violated";
}
const char* true_word(const Guaranteed& of) {
    return misses_success(of) ? "violated" : "satisfied";
}

void add(OtherError& error, const Fraction& episode) {
    error.cases += episode.whole;
    error.errors += static_cast<std::uint64_t>(episode.part);
    error.episodes += episode.whole > 0 ? 1 : 0;
    error.wrong += episode.part > 0 ? 1 : 0;
}

/// Sets the intervals of all errors from the same resamples.
void set_intervals(std::vector<OtherError>& errors, const std::vector<Fractions>& fractions) {
    std::vector<std::size_t> resampled;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        OtherError& error = errors[i];
        if (!error.why.empty() || error.cases == 0) continue;
        const double bound = std::pow(0.025, 1 / static_cast<double>(error.episodes));
        if (error.errors == 0)
            error.interval = {0, 1 - bound};
        else if (error.errors == error.cases)
            error.interval = {bound, 1};
        else if (error.episodes >= OtherError::kLeastEpisodes)
            resampled.push_back(i);
    }
    if (resampled.empty()) return;
    std::vector<std::vector<std::optional<double>>> values(errors.size());
    const episodes::Bootstrap bootstrap(fractions[resampled.front()].size());
    bootstrap.for_each_batch([&](const episodes::Weights& weights) {
        for (const std::size_t i : resampled) {
            const auto some = episodes::shares(fractions[i], weights);
            values[i].insert(values[i].end(), some.begin(), some.end());
        }
    });
    for (const std::size_t i : resampled)
        errors[i].interval = episodes::percentile_interval(values[i]);
}

/// Counts the errors of guarantees. `thresholds_of(e)` returns those of an episode. An error with
/// a reason not to be counted is left as it is.
template <class ThresholdsOf>
void count(const check::Model& model, const std::vector<Guaranteed>& all, const Tracked& recorded,
           const ThresholdsOf& thresholds_of, std::vector<OtherError>& errors) {
    const auto is_counted = [](const OtherError& error) { return error.why.empty(); };
    if (std::none_of(errors.begin(), errors.end(), is_counted)) return;
    const auto replayer = Replayer::make(model, all, recorded.watched);
    if (!replayer) {
        for (OtherError& error : errors)
            if (is_counted(error)) error.why = "the monitors exceed the limits";
        return;
    }
    std::vector<Fractions> fractions(all.size(), Fractions(recorded.tracks.size()));
    recorded.tracks.for_each([&](std::size_t e, const std::string& track) {
        const std::vector<Said> episode = replayer->replay(track, thresholds_of(e));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Said& said = episode[i];
            const std::uint64_t truly_violated = said.steps - said.truly_satisfied;
            const bool success = misses_success(all[i]);
            errors[i].steps += said.steps;
            errors[i].said += success ? said.satisfied : said.violated;
            errors[i].truly += success ? said.truly_satisfied : truly_violated;
            fractions[i][e] = {
                static_cast<std::int64_t>(success ? said.falsely_satisfied : said.falsely_violated),
                success ? truly_violated : said.truly_satisfied};
            add(errors[i], fractions[i][e]);
        }
    });
    set_intervals(errors, fractions);
}

std::string percent(double share) {
    return fmt::format("{:.1f}", 100 * share);
}

/// Returns "54.9 % [51.0, 58.9]".
std::string share_of(const OtherError& error) {
    std::string text = percent(error.share()) + " %";
    if (error.interval)
        text +=
            fmt::format(" [{}, {}]", percent(error.interval->low), percent(error.interval->high));
    return text;
}

constexpr const char* kHead = "the other error: ";

/// Returns the line where nothing was counted; otherwise nothing.
std::optional<std::string> nothing_counted(const OtherError& error, const std::string& no_case) {
    if (!error.why.empty()) return fmt::format("{}not counted: {}\n", kHead, error.why);
    if (error.cases == 0) return fmt::format("{}nothing to judge it on: {}\n", kHead, no_case);
    return std::nullopt;
}

}  // namespace

std::vector<Guaranteed> guaranteed(const check::Model& model) {
    std::vector<Guaranteed> found;
    for (Index m = 0; m < model.monitors.size(); ++m) {
        const check::Monitor& monitor = model.monitors[m];
        if (monitor.calibration) continue;
        for (const Claim& claim : check::claims(model, monitor))
            if (claim.kind == Claim::Kind::missed_success ||
                claim.kind == Claim::Kind::missed_alarm)
                found.push_back({m, claim});
    }
    return found;
}

namespace {

/// Whether a comparison in the monitor's truth is in no part of the monitor: episodes are kept as
/// what the monitor measures, and labels.
bool measures_in_its_truth(const check::Model& model, const check::Monitor& monitor) {
    const auto measured = check::predicates_of(model, monitor.formula);
    const auto judging = check::predicates_of(model, monitor.true_formula());
    return std::any_of(judging.begin(), judging.end(), [&](Index p) {
        return check::is_own_truth(model, p) &&
               !std::binary_search(measured.begin(), measured.end(), p);
    });
}

}  // namespace

std::vector<OtherError> other_errors(const check::Model& model,
                                     const std::vector<Index>& predicates,
                                     const std::vector<Evidence>& evidence,
                                     const std::vector<LeftOut>& out) {
    std::vector<OtherError> errors(predicates.size());
    std::vector<Fractions> fractions(predicates.size());
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        const check::Predicate& predicate = model.predicates[predicates[i]];
        errors[i].groups = out[i].groups;
        if (!out[i].why.empty()) {
            errors[i].why = "without one demonstration " + out[i].why;
            continue;
        }
        fractions[i].resize(evidence[i].demonstrations);
        evidence[i].labelled.for_each([&](const episodes::Scored& frame) {
            if (frame.positive) return;
            const float delta = predicate.upper_bound() ? frame.score : -frame.score;
            const float threshold = out[i].thresholds[frame.episode];
            ++fractions[i][frame.episode].whole;
            fractions[i][frame.episode].part +=
                check::holds(predicate.comparison, delta, threshold) ? 1 : 0;
        });
        for (const Fraction& episode : fractions[i]) add(errors[i], episode);
    }
    set_intervals(errors, fractions);
    return errors;
}

std::vector<OtherError> other_errors(const check::Model& model, const std::vector<Guaranteed>& all,
                                     const std::vector<Index>& predicates,
                                     const std::vector<LeftOut>& out, const Tracked& recorded) {
    std::vector<OtherError> errors(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const check::Monitor& monitor = model.monitors[all[i].monitor];
        const Index formula = all[i].claim.formula;
        if (!all[i].claim.part.empty() && monitor.restarts != check::Restarts::never)
            errors[i].why = "a part of a monitor that restarts";
        bool reads_more = !check::flags_of(model, formula).empty();
        for (const Index p : check::predicates_of(model, formula)) {
            const auto found = std::find(predicates.begin(), predicates.end(), p);
            reads_more |= found == predicates.end();
            if (found == predicates.end()) continue;
            const LeftOut& of = out[static_cast<std::size_t>(found - predicates.begin())];
            if (!of.why.empty() && errors[i].why.empty())
                errors[i].why = fmt::format("without one demonstration {}, for '{}'", of.why,
                                            model.predicates[p].name);
        }
        if (reads_more && !recorded.is_complete && errors[i].why.empty())
            errors[i].why = "some demonstrations lack an input that the monitor reads";
    }
    Thresholds thresholds;
    for (const check::Predicate& predicate : model.predicates)
        thresholds.predicates.push_back(predicate.threshold.value);
    count(
        model, all, recorded,
        [&](std::size_t e) -> const Thresholds& {
            for (std::size_t i = 0; i < predicates.size(); ++i)
                if (out[i].why.empty()) thresholds.predicates[predicates[i]] = out[i].thresholds[e];
            return thresholds;
        },
        errors);
    return errors;
}

std::vector<OtherError> other_errors_of_shifts(const check::Model& model,
                                               const std::vector<Guaranteed>& all,
                                               const std::vector<LeftOut>& out,
                                               const Tracked& recorded) {
    std::vector<OtherError> errors(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        if (!out[i].why.empty())
            errors[i].why = "without one episode " + out[i].why;
        else if (measures_in_its_truth(model, model.monitors[all[i].monitor]))
            errors[i].why = "its truth measures something that the monitor does not";
    Thresholds thresholds;
    for (const check::Predicate& predicate : model.predicates)
        thresholds.predicates.push_back(predicate.threshold.value);
    thresholds.shifts.resize(all.size());
    count(
        model, all, recorded,
        [&](std::size_t e) -> const Thresholds& {
            for (std::size_t i = 0; i < all.size(); ++i)
                if (out[i].why.empty()) thresholds.shifts[i] = out[i].thresholds[e];
            return thresholds;
        },
        errors);
    return errors;
}

std::string describe(const OtherError& error) {
    if (const auto nothing = nothing_counted(error, "no measured frame is negative"))
        return *nothing;
    std::string text = fmt::format("{}true at {} of {} negative frames, {}", kHead, error.errors,
                                   error.cases, share_of(error));
    if (error.groups > 0)
        text += fmt::format("; demonstrations left out in {} groups", error.groups);
    return text + "\n";
}

std::string describe(const OtherError& error, const Guaranteed& of, const std::string& indent) {
    if (const auto nothing =
            nothing_counted(error, fmt::format("no step is truly {}", true_word(of))))
        return indent + *nothing;
    return fmt::format(
        "{}{}{} at {} of {} truly {} steps, {}; in {} of {} episodes\n"
        "{}in all {} at {} of {} steps, truly at {}\n",
        indent, kHead, said_word(of), error.errors, error.cases, true_word(of), share_of(error),
        error.wrong, error.episodes, indent, said_word(of), error.said, error.steps, error.truly);
}

void warn_of_empty(const check::Model& model, const Guaranteed& of, const OtherError& error,
                   diag::Sink& sink) {
    constexpr double kNearlyAll = 0.9;
    constexpr double kMost = 0.5;
    if (!error.why.empty() || error.cases == 0 || error.share() < kNearlyAll) return;
    if (!error.interval || error.interval->low <= kMost) return;
    const check::Monitor& monitor = model.monitors[of.monitor];
    const std::string part =
        of.claim.part.empty() ? "" : fmt::format("the part {} of ", of.claim.part);
    diag::Diagnostic& warning = episodes::warn_of_data(
        diag::Code::empty_guarantee,
        fmt::format("the guarantee holds, and is empty: {}'{}' is {} at {:.0f} % of the steps at "
                    "which it is truly {}",
                    part, monitor.name, said_word(of), std::floor(100 * error.share()),
                    true_word(of)),
        monitor.span, sink);
    warning.note(
        fmt::format("{} of {} in {}, each with the thresholds of the others; 95 % "
                    "interval from {} to {} %",
                    error.errors, counted(error.cases, "step"), counted(error.episodes, "episode"),
                    percent(error.interval->low), percent(error.interval->high)));
    warning.note(fmt::format(
        "try a predicate that has to hold for some steps (held[5 steps] p), {}or a distance that "
        "separates better (etlc fit --suggest)",
        monitor.calibration ? "" : "a monitor that is calibrated as a whole, "));
}

}  // namespace etlc::calibrate
