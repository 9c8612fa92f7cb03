// The lines of a report about the other errors, and the warning about an empty guarantee.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "calibrate/other_error.hpp"
#include "episodes/data_warnings.hpp"

namespace etlc::calibrate {

namespace {

using diag::counted;

/// Returns the verdict of the other error, and that of its truth.
const char* said_word(const Guaranteed& of) {
    return of.misses_success() ? "satisfied" : "violated";
}
const char* true_word(const Guaranteed& of) {
    return of.misses_success() ? "violated" : "satisfied";
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

constexpr const char* kHead = "the other error: ";

/// Returns the line where nothing was counted; otherwise nothing.
std::optional<std::string> nothing_counted(const OtherError& error, const std::string& no_case) {
    if (!error.why.empty()) return fmt::format("{}not counted: {}\n", kHead, error.why);
    if (error.cases == 0) return fmt::format("{}nothing to judge it on: {}\n", kHead, no_case);
    return std::nullopt;
}

}  // namespace

std::string describe(const OtherError& error) {
    if (const auto nothing = nothing_counted(error, "no measured frame is negative"))
        return *nothing;
    std::string text = fmt::format("{}true at {} of {} negative frames, {}", kHead, error.errors,
                                   error.cases, share_of(error));
    if (error.parts > 0)
        text += fmt::format("; {} left out in {} parts",
                            error.by_group ? "groups" : "demonstrations", error.parts);
    return text + "\n";
}

std::string note_on_other_errors(bool by_group) {
    const char* const each = by_group ? "group" : "episode";
    return fmt::format(
        "    The other error is counted in each {0} with the thresholds that the other {0}s give; "
        "in brackets its 95 % interval over {0}s.\n",
        each);
}

namespace {

std::uint64_t all_made(const VariantError& error) {
    return std::accumulate(error.made.begin(), error.made.end(), std::uint64_t{0});
}

/// Returns "153 broken variants (cut 40, swapped 38, reversed 40, frozen 35)".
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
    return fmt::format("{} on {} of {} truly {}", said_word(of), error.errors, error.cases,
                       true_word(of));
}

/// Returns the line about broken variants.
std::string describe(const VariantError& error, const Guaranteed& of) {
    if (!error.why.empty()) return fmt::format("broken variants not judged: {}\n", error.why);
    if (all_made(error) == 0) return "no broken variants: the episodes are too short\n";
    if (error.cases == 0)
        return fmt::format("on {}: none is truly {}\n", made(error), true_word(of));
    return fmt::format("on {}: {}, {}\n", made(error), errors_of(error, of), share_of(error));
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
    if (const auto nothing =
            nothing_counted(error, fmt::format("no step is truly {}", true_word(of))))
        text += *nothing;
    else
        text += fmt::format(
            "{}{} at {} of {} truly {} steps, {}; in {} of {} {}s\n"
            "{}in all {} at {} of {} steps, truly at {}\n",
            kHead, said_word(of), error.errors, error.cases, true_word(of), share_of(error),
            error.wrong, error.groups, error.by_group ? "group" : "episode", indent, said_word(of),
            error.said, error.steps, error.truly);
    return error.why.empty() ? text + indent + describe(error.variants, of) : text;
}

void warn_of_empty(const check::Model& model, const Guaranteed& of, const OtherError& error,
                   diag::Sink& sink) {
    const bool by_steps = is_empty(error);
    const bool by_variants = is_wrong_on_most(error.variants);
    if (!by_steps && !by_variants) return;
    const check::Monitor& monitor = model.monitors[of.monitor];
    const auto share = [](const ErrorShare& one) { return std::floor(100 * one.share()); };
    const std::string subject = fmt::format(
        "{}'{}' is {}", of.claim.part.empty() ? "" : fmt::format("the part {} of ", of.claim.part),
        monitor.name, said_word(of));
    diag::Diagnostic& warning = episodes::warn_of_data(
        diag::Code::empty_guarantee,
        by_steps ? fmt::format("the guarantee holds, and is empty: {} at {:.0f} % of the steps at "
                               "which it is truly {}",
                               subject, share(error), true_word(of))
                 : fmt::format("the guarantee holds, and says little: {} on {:.0f} % of the broken "
                               "variants on which it is truly {}",
                               subject, share(error.variants), true_word(of)),
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
        "try a predicate that has to hold for some steps (held[5 steps] p), {}or a distance that "
        "separates better (etlc fit --suggest)",
        monitor.calibration ? "" : "a monitor that is calibrated as a whole, "));
}

}  // namespace etlc::calibrate
