#include "calibrate/other_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "check/guarantees/provenance.hpp"
#include "episodes/admission/admission.hpp"

namespace etlc::calibrate {

namespace {

using check::Guarantee;
using episodes::Fraction;
using episodes::Label;
using Open = Guaranteed::Open;

/// Counts per group, for intervals.
using Fractions = std::vector<Fraction>;

struct Counted {
    ErrorShare& error;
    const Fractions& fractions;
};

void add(ErrorShare& error, const Fractions& groups) {
    for (const Fraction& group : groups) {
        error.cases += group.whole;
        error.errors += static_cast<std::uint64_t>(group.part);
        error.groups += group.whole > 0 ? 1 : 0;
        error.wrong += group.part > 0 ? 1 : 0;
    }
}

/// Sets the intervals of all errors from the same resamples.
void set_intervals(const std::vector<Counted>& counted) {
    std::vector<Counted> resampled;
    for (const Counted& one : counted) {
        ErrorShare& error = one.error;
        if (!error.why.empty() || error.cases == 0) continue;
        const double bound = std::pow(0.025, 1 / static_cast<double>(error.groups));
        if (error.errors == 0)
            error.interval = {0, 1 - bound};
        else if (error.errors == error.cases)
            error.interval = {bound, 1};
        else if (error.groups >= ErrorShare::kLeastGroups)
            resampled.push_back(one);
    }
    if (resampled.empty()) return;
    std::vector<std::vector<std::optional<double>>> values(resampled.size());
    const episodes::Bootstrap bootstrap(resampled.front().fractions.size());
    bootstrap.for_each_batch([&](const episodes::Weights& weights) {
        for (std::size_t i = 0; i < resampled.size(); ++i) {
            const auto some = episodes::shares(resampled[i].fractions, weights);
            values[i].insert(values[i].end(), some.begin(), some.end());
        }
    });
    for (std::size_t i = 0; i < resampled.size(); ++i)
        resampled[i].error.interval = episodes::percentile_interval(values[i]);
}

/// Returns for each formula whether it depends on earlier frames.
std::vector<bool> over_time(const check::Model& model) {
    std::vector<bool> result(model.formulas.size());
    for (Index f = 0; f < model.formulas.size(); ++f) {  // operands come first
        const check::Formula& of = model.formulas[f];
        result[f] = check::looks_back(of.kind) ||
                    std::any_of(of.operands.begin(), of.operands.end(),
                                [&](Index operand) { return result[operand]; });
    }
    return result;
}

/// Returns why a track with its steps in another order is not what the monitors see of the
/// reordered recording; empty if it is.
std::string why_no_variants(const check::Model& model, const Tracked& recorded) {
    const Watched& watched = recorded.watched;
    std::set<Index> inputs(watched.flags.begin(), watched.flags.end());
    const auto add_inputs = [&](const std::vector<Index>& predicates) {
        for (const Index p : predicates)
            inputs.insert(model.predicates[p].inputs.begin(), model.predicates[p].inputs.end());
    };
    add_inputs(watched.predicates);
    std::set<Index> labelled(watched.labelled.begin(), watched.labelled.end());
    labelled.insert(watched.dividing.begin(), watched.dividing.end());
    const std::vector<bool> looks_back = over_time(model);
    for (const check::Truth& truth : model.truths) {
        if (truth.formula == check::kNone || !labelled.contains(truth.predicate)) continue;
        if (looks_back[truth.formula])
            return fmt::format("the truth of '{}' looks back, so its labels depend on the order",
                               model.predicates[truth.predicate].name);
        add_inputs(check::predicates_of(model, truth.formula));
        const std::vector<Index> flags = check::flags_of(model, truth.formula);
        inputs.insert(flags.begin(), flags.end());
    }
    for (const Index input : inputs)
        if (model.inputs[input].has_state())
            return fmt::format("'{}' has {}, so its samples depend on the order",
                               model.inputs[input].name,
                               model.inputs[input].hold > 0 ? "hold" : "stale after");
    return recorded.is_divided ? "" : "some demonstrations lack labels that tell where to cut them";
}

/// Counts the errors in the verdicts on the variants of an episode.
void add_variants(const std::vector<Broken>& variants, const std::vector<Guaranteed>& all,
                  std::size_t group, std::vector<Fractions>& fractions,
                  std::vector<OtherError>& errors) {
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool is_cost = all[i].open == Open::unknown;
        const Label wrong = is_cost                          ? Label::unknown
                            : all[i].open == Open::satisfied ? Label::yes
                                                             : Label::no;
        const Label right = wrong == Label::yes ? Label::no : Label::yes;
        VariantError& error = errors[i].variants;
        Fraction& of = fractions[i][group];
        for (const Broken& broken : variants) {
            ++error.made[static_cast<std::size_t>(broken.variant)];
            const Concluded& verdicts = broken.concluded[i];
            if (all[i].open == Open::violated && verdicts.actual == Label::no) {
                ++error.missed_alarms.whole;
                error.missed_alarms.part += verdicts.predicted == Label::yes ? 1 : 0;
            }
            if (!is_cost && verdicts.actual != right) continue;
            ++of.whole;
            of.part += verdicts.predicted == wrong ? 1 : 0;
        }
    }
}

/// Adds how late the monitor says in an episode that it is satisfied.
void add_lateness(const VerdictCounts& counts, OtherError& error) {
    if (counts.first_truly_satisfied == 0) return;
    if (counts.first_satisfied == 0)
        ++error.never;
    else
        error.lateness.push_back(std::max(counts.first_satisfied, counts.first_truly_satisfied) -
                                 counts.first_truly_satisfied);
}

/// Counts the errors of guarantees. `thresholds_of(g)` returns those of a group. An error with a
/// reason not to be counted is left as it is.
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
    const std::string why_no = why_no_variants(model, recorded);
    for (OtherError& error : errors) error.variants.why = error.why.empty() ? why_no : error.why;
    std::vector<Fractions> fractions(all.size(), Fractions(recorded.groups.count()));
    std::vector<Fractions> of_variants = fractions;
    recorded.tracks.for_each([&](std::size_t e, const std::string& track) {
        const std::uint32_t group = recorded.groups.of(e);
        const Thresholds& thresholds = thresholds_of(group);
        const std::vector<VerdictCounts> episode = replayer->replay(track, thresholds);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const VerdictCounts& counts = episode[i];
            const std::uint64_t truly_violated = counts.steps - counts.truly_satisfied;
            const bool success = all[i].open == Open::satisfied;
            errors[i].all += counts.all;
            errors[i].steps += counts.steps;
            if (all[i].open == Open::unknown) {
                fractions[i][group].part += static_cast<std::int64_t>(counts.unknown);
                fractions[i][group].whole += counts.all;
                continue;
            }
            if (all[i].open == Open::violated) add_lateness(counts, errors[i]);
            errors[i].predicted += success ? counts.satisfied : counts.violated;
            errors[i].actual += success ? counts.truly_satisfied : truly_violated;
            fractions[i][group].part += static_cast<std::int64_t>(
                success ? counts.falsely_satisfied : counts.falsely_violated);
            fractions[i][group].whole += success ? truly_violated : counts.truly_satisfied;
        }
        if (why_no.empty())
            add_variants(replayer->replay_variants(track, thresholds), all, group, of_variants,
                         errors);
    });
    std::vector<Counted> counted;
    for (std::size_t i = 0; i < all.size(); ++i) {
        errors[i].by_group = recorded.groups.are_named();
        add(errors[i], fractions[i]);
        add(errors[i].variants, of_variants[i]);
        counted.push_back({errors[i], fractions[i]});
        counted.push_back({errors[i].variants, of_variants[i]});
    }
    set_intervals(counted);
}

/// Returns the thresholds of all predicates, and room for those of the guarantees.
Thresholds thresholds_of(const check::Model& model, std::size_t guarantees) {
    Thresholds result{{}, std::vector<check::Both>(guarantees)};
    for (const check::Predicate& predicate : model.predicates)
        result.predicates.push_back({predicate.threshold.value, predicate.threshold.inner});
    return result;
}

/// Returns what is left out of the others.
const char* one_of(const episodes::Groups& groups, const char* otherwise) {
    return groups.are_named() ? "group" : otherwise;
}

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
                                     const std::vector<LeftOut>& out,
                                     const episodes::Groups& groups) {
    std::vector<OtherError> errors(predicates.size());
    std::vector<Fractions> fractions(predicates.size());
    for (std::size_t i = 0; i < predicates.size(); ++i) {
        const check::Predicate& predicate = model.predicates[predicates[i]];
        errors[i].parts = out[i].parts;
        errors[i].by_group = groups.are_named();
        if (!out[i].why.empty()) {
            errors[i].why =
                fmt::format("without one {} {}", one_of(groups, "demonstration"), out[i].why);
            continue;
        }
        fractions[i].resize(groups.count());
        const check::Against against = predicate.threshold.against;
        const bool is_cost = against == check::Against::both;
        const bool of_positives = against == check::Against::false_positives;
        evidence[i].labelled.for_each([&](const episodes::Scored& frame) {
            if (!is_cost && frame.positive != of_positives) return;
            const float delta = predicate.upper_bound() ? frame.score : -frame.score;
            const check::Both& threshold = out[i].thresholds[frame.episode];
            const auto called =
                check::called(predicate.comparison, delta, threshold.low(), threshold.value);
            const auto wrong = is_cost ? std::nullopt : std::optional(!of_positives);
            ++fractions[i][frame.episode].whole;
            fractions[i][frame.episode].part += called == wrong ? 1 : 0;
        });
        add(errors[i], fractions[i]);
    }
    std::vector<Counted> counted;
    for (std::size_t i = 0; i < errors.size(); ++i) counted.push_back({errors[i], fractions[i]});
    set_intervals(counted);
    return errors;
}

std::vector<OtherError> other_errors(const check::Model& model, const std::vector<Guaranteed>& all,
                                     const std::vector<Index>& predicates,
                                     const std::vector<LeftOut>& out, const Tracked& recorded) {
    std::vector<OtherError> errors(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const check::Monitor& monitor = model.monitors[all[i].monitor];
        const Index formula = all[i].guarantee.formula;
        if (!all[i].guarantee.part.empty() && monitor.restarts != check::Restarts::never)
            errors[i].why = "a part of a monitor that restarts";
        bool reads_more = !check::flags_of(model, formula).empty();
        for (const Index p : check::predicates_of(model, formula)) {
            const auto found = std::find(predicates.begin(), predicates.end(), p);
            reads_more |= found == predicates.end();
            if (found == predicates.end()) continue;
            const LeftOut& of = out[static_cast<std::size_t>(found - predicates.begin())];
            if (!of.why.empty() && errors[i].why.empty())
                errors[i].why = fmt::format("without one {} {}, for '{}'",
                                            one_of(recorded.groups, "demonstration"), of.why,
                                            model.predicates[p].name);
        }
        if (reads_more && !recorded.is_complete && errors[i].why.empty())
            errors[i].why = "some demonstrations lack an input that the monitor reads";
    }
    Thresholds thresholds = thresholds_of(model, all.size());
    count(
        model, all, recorded,
        [&](std::uint32_t group) -> const Thresholds& {
            for (std::size_t i = 0; i < predicates.size(); ++i)
                if (out[i].why.empty())
                    thresholds.predicates[predicates[i]] = out[i].thresholds[group];
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
            errors[i].why =
                fmt::format("without one {} {}", one_of(recorded.groups, "episode"), out[i].why);
        else if (measures_in_its_truth(model, model.monitors[all[i].monitor]))
            errors[i].why = "its truth measures something that the monitor does not";
    Thresholds thresholds = thresholds_of(model, all.size());
    count(
        model, all, recorded,
        [&](std::uint32_t group) -> const Thresholds& {
            for (std::size_t i = 0; i < all.size(); ++i)
                if (out[i].why.empty()) thresholds.shifts[i] = out[i].thresholds[group];
            return thresholds;
        },
        errors);
    return errors;
}

// ---- the lines of a report, and the warning about an empty guarantee ----------------------------

namespace {

using diag::counted;

/// Returns the verdict of the other error, and that of its truth.
const char* predicted_word(const Guaranteed& of) {
    return of.open == Open::unknown     ? "unknown"
           : of.open == Open::satisfied ? "satisfied"
                                        : "violated";
}
const char* actual_word(const Guaranteed& of) {
    return of.open == Open::satisfied ? "violated" : "satisfied";
}

std::string percent(double share) {
    return fmt::format("{:.1f}", 100 * share);
}

/// Returns "54.9 % [51.0, 58.9]".
std::string share_of(const ErrorShare& error) {
    std::string text = percent(error.share()) + " %";
    if (error.interval)
        text +=
            fmt::format(" [{}, {}]", percent(error.interval->low), percent(error.interval->high));
    return text;
}

const char* head(bool is_cost) {
    return is_cost ? "the cost: " : "the other error: ";
}

/// Returns the line where nothing was counted; otherwise nothing.
std::optional<std::string> nothing_counted(const OtherError& error, bool is_cost,
                                           const std::string& no_case) {
    if (!error.why.empty()) return fmt::format("{}not counted: {}\n", head(is_cost), error.why);
    if (error.cases == 0)
        return fmt::format("{}nothing to judge it on: {}\n", head(is_cost), no_case);
    return std::nullopt;
}

}  // namespace

std::string describe(const OtherError& error, check::Against against) {
    const bool is_cost = against == check::Against::both;
    const bool of_positives = against == check::Against::false_positives;
    const char* const kind = is_cost ? "labelled" : of_positives ? "positive" : "negative";
    if (const auto nothing =
            nothing_counted(error, is_cost, fmt::format("no measured frame is {}", kind)))
        return *nothing;
    std::string text = fmt::format("{}{} at {} of {} {} frames, {}", head(is_cost),
                                   is_cost        ? "unknown"
                                   : of_positives ? "false"
                                                  : "true",
                                   error.errors, error.cases, kind, share_of(error));
    if (error.parts > 0)
        text += fmt::format("; {} left out in {} parts",
                            error.by_group ? "groups" : "demonstrations", error.parts);
    return text + "\n";
}

bool has_cost(const std::vector<Guaranteed>& all) {
    return std::any_of(all.begin(), all.end(),
                       [](const Guaranteed& one) { return one.open == Open::unknown; });
}

std::string note_on_other_errors(bool by_group, bool has_cost) {
    const char* const each = by_group ? "group" : "episode";
    return fmt::format(
        "    The other error {1} counted in each {0} with the thresholds that the other {0}s give; "
        "in brackets {2} 95 % interval over {0}s for these thresholds; a new calibration "
        "gives others, whose error may lie outside.\n",
        each, has_cost ? "and the cost are" : "is", has_cost ? "their" : "its");
}

namespace {

std::uint64_t all_made(const VariantError& error) {
    return std::accumulate(error.made.begin(), error.made.end(), std::uint64_t{0});
}

/// Returns "153 broken variants (cut 40, phases_reversed 38, reversed 40, frozen 35)".
std::string made(const VariantError& error) {
    std::string kinds;
    for (const auto& [variant, name] : episodes::kVariants) {
        const std::uint64_t some = error.made[static_cast<std::size_t>(variant)];
        if (some > 0) kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", name, some);
    }
    return fmt::format("{} ({})", counted(all_made(error), "broken variant"), kinds);
}

/// Returns "satisfied on 12 of 140 truly violated".
std::string errors_of(const VariantError& error, const Guaranteed& of) {
    if (of.open == Open::unknown)
        return fmt::format("unknown on {} of {}", error.errors, error.cases);
    return fmt::format("{} on {} of {} truly {}", predicted_word(of), error.errors, error.cases,
                       actual_word(of));
}

/// Returns the line about broken variants.
std::string describe(const VariantError& error, const Guaranteed& of) {
    if (!error.why.empty()) return fmt::format("broken variants not judged: {}\n", error.why);
    if (all_made(error) == 0) return "no broken variants: the episodes are too short\n";
    std::string text = fmt::format("on {}: ", made(error));
    text += error.cases == 0 ? fmt::format("none is truly {}", actual_word(of))
                             : fmt::format("{}, {}", errors_of(error, of), share_of(error));
    if (error.missed_alarms.whole > 0)
        text += fmt::format("; satisfied on {} of {} truly violated", error.missed_alarms.part,
                            error.missed_alarms.whole);
    return text + "\n";
}

/// Returns the line about when a monitor that must not miss an alarm is satisfied; "" for others.
std::string describe_lateness(const OtherError& error) {
    std::vector<std::uint64_t> late = error.lateness;
    if (late.empty() && error.never == 0) return "";
    std::string text;
    if (!late.empty()) {
        const auto middle = late.begin() + static_cast<std::ptrdiff_t>((late.size() - 1) / 2);
        std::nth_element(late.begin(), middle, late.end());
        text = fmt::format("satisfied a median of {} after it truly is, in {}",
                           counted(*middle, "step"), counted(late.size(), "episode"));
    }
    if (error.never > 0)
        text += fmt::format("{}never satisfied in {} in which it truly is",
                            late.empty() ? "" : "; ", counted(error.never, "episode"));
    return text + "\n";
}

/// Whether the monitor says the same at nearly all steps, in most of such data.
bool is_empty(const OtherError& error) {
    constexpr double kNearlyAll = 0.9;
    constexpr double kMost = 0.5;
    if (!error.why.empty() || error.cases == 0 || error.share() < kNearlyAll) return false;
    return error.interval && error.interval->low > kMost;
}

/// Whether the monitor takes most broken variants for what they are not.
bool is_wrong_on_most(const VariantError& error) {
    constexpr std::uint64_t kLeast = 5;
    return error.why.empty() && error.cases >= kLeast && 2 * error.errors > error.cases;
}

}  // namespace

std::string describe(const OtherError& error, const Guaranteed& of, const std::string& indent) {
    std::string text = indent;
    const bool is_cost = of.open == Open::unknown;
    const char* const each = error.by_group ? "group" : "episode";
    const std::string no_case =
        is_cost ? "there is no verdict" : fmt::format("no step is truly {}", actual_word(of));
    if (const auto nothing = nothing_counted(error, is_cost, no_case))
        text += *nothing;
    else if (is_cost)
        text += fmt::format("{}unknown at {} of {} steps, {}; in {} of {} {}s\n", head(true),
                            error.errors, error.cases, share_of(error), error.wrong, error.groups,
                            each);
    else
        text += fmt::format(
            "{}{} at {} of {} truly {} steps, {}; in {} of {} {}s\n"
            "{}in all {} at {} of {} steps, truly at {}\n",
            head(false), predicted_word(of), error.errors, error.cases, actual_word(of),
            share_of(error), error.wrong, error.groups, each, indent, predicted_word(of),
            error.predicted, error.steps, error.actual);
    if (error.why.empty() && error.steps < error.all)
        text += fmt::format("{}the truth is open at {} of {} steps\n", indent,
                            error.all - error.steps, error.all);
    if (!error.why.empty()) return text;
    if (const std::string late = describe_lateness(error); !late.empty()) text += indent + late;
    return text + indent + describe(error.variants, of);
}

void warn_of_empty(const check::Model& model, const Guaranteed& of, const OtherError& error,
                   diag::Sink& sink) {
    if (of.open == Open::unknown) return;  // that it says little is not hidden
    const bool by_steps = is_empty(error);
    const bool by_variants = is_wrong_on_most(error.variants);
    if (!by_steps && !by_variants) return;
    const check::Monitor& monitor = model.monitors[of.monitor];
    const auto share = [](const ErrorShare& one) { return std::floor(100 * one.share()); };
    const std::string subject = fmt::format(
        "{}'{}' is {}",
        of.guarantee.part.empty() ? "" : fmt::format("the part {} of ", of.guarantee.part),
        monitor.name, predicted_word(of));
    diag::Diagnostic& warning = episodes::warn_of_data(
        diag::Code::empty_guarantee,
        by_steps ? fmt::format("the guarantee holds, and is empty: {} at {:.0f} % of the steps at "
                               "which it is truly {}",
                               subject, share(error), actual_word(of))
                 : fmt::format("the guarantee holds, and says little: {} on {:.0f} % of the broken "
                               "variants on which it is truly {}",
                               subject, share(error.variants), actual_word(of)),
        monitor.span, sink);
    if (by_steps)
        warning.note(fmt::format(
            "{} of {} in {}, each with the thresholds of the others; 95 % interval from {} to {} %",
            error.errors, counted(error.cases, "step"),
            counted(error.groups, error.by_group ? "group" : "episode"),
            percent(error.interval->low), percent(error.interval->high)));
    if (by_variants)
        warning.note(fmt::format("of {}: {}", made(error.variants), errors_of(error.variants, of)));
    warning.note(fmt::format(
        "try 'against = both', with which a verdict is unknown where it may be wrong, a predicate "
        "that has to hold for some steps (held[5 steps] p), {}or a distance that separates better "
        "(etlc fit --suggest)",
        monitor.calibration ? "" : "a monitor that is calibrated as a whole, "));
}

}  // namespace etlc::calibrate
