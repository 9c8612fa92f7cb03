#include "check/formulas/durations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/formulas/horizons.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/guarantees.hpp"

namespace etlc::check {

namespace {

using diag::Code;
using Kind = Formula::Kind;

/// Whether a longer interval makes an operator truer.
bool is_existential(Kind kind) {
    return kind == Kind::eventually || kind == Kind::until || kind == Kind::once ||
           kind == Kind::since || kind == Kind::count;
}

/// Finds out in which direction the duration moves the monitor; false after an error.
bool set_direction(Context& c, const Monitor& monitor, Duration& duration) {
    bool truer = false;
    bool falser = false;
    for_each_literal(c.model, monitor.formula, [&](Index at, bool negated) {
        const Formula& formula = c.model.formulas[at];
        if (formula.time == Formula::Time::written) return;
        (is_existential(formula.kind) != negated ? truer : falser) = true;
    });
    duration.longer_is_truer = truer;
    if (truer != falser) return true;
    c.report(Code::calibration_not_available, duration.threshold.span,
             fmt::format("a longer time makes '{}' truer in one place and falser in another, so no "
                         "time bounds its false alarms; expected one direction",
                         monitor.name))
        .note(
            "rise, fall, <->, a formula inside a count, and a count compared by == or != read "
            "their operands both ways");
    return false;
}

/// Returns the first position at which the falsest duration can make the monitor violated for good.
std::uint64_t first_alarm(Model& model, const Monitor& monitor, const Duration& duration) {
    set_duration(model, monitor, duration.longer_is_truer ? duration.least : duration.greatest,
                 Formula::Time::open);
    const std::uint64_t found = decidable(model, Lasts::for_good, true)[monitor.formula].violated;
    // Until it is known, one that keeps all parts of the formula: p U[0, 0] q is q.
    set_duration(model, monitor, std::min(duration.least + 1, duration.greatest),
                 Formula::Time::open);
    return found;
}

/// Returns why the monitor can have no calibrated duration; empty if it can.
std::string why_not(const Monitor& monitor) {
    if (monitor.sliding)
        return "a sliding monitor judges every position, and the guarantee is about one verdict of "
               "an episode; write a monitor 'G (...)'";
    if (monitor.restarts != Restarts::never)
        return "it judges an episode several times, and the guarantee is about one verdict; remove "
               "'restartable' or 'repeating'";
    if (monitor.calibration)
        return "it is calibrated as a whole too, and its shift would change the times; calibrate "
               "one of the two";
    return "";
}

}  // namespace

bool add_duration(Context& c, const ast::Calibrated& written, std::uint32_t least,
                  std::uint32_t greatest) {
    if (c.duration == nullptr)
        return c.refuse(Code::calibration_not_available, written.span,
                        "a calibrated duration belongs to a monitor: expected a time here, or this "
                        "formula written out in the monitor");
    if (c.duration->has_value())
        return c.refuse(Code::calibration_not_available, written.span,
                        "a second calibrated duration in one monitor, whose times would depend on "
                        "the first; expected a time, or two monitors");
    auto threshold = check_duration_calibrated(c, written);
    if (!threshold) return false;
    *c.duration = Duration{std::move(*threshold), least, greatest};
    return true;
}

void check_duration(Context& c, Monitor& monitor) {
    Duration& duration = *monitor.duration;
    const Span at = duration.threshold.span;
    if (const std::string why = why_not(monitor); !why.empty()) {
        c.report(Code::calibration_not_available, at,
                 fmt::format("'{}' can have no calibrated duration: {}", monitor.name, why));
        return;
    }
    if (!set_direction(c, monitor, duration)) return;
    if (first_alarm(c.model, monitor, duration) != Decidable::kNever) return;
    c.report(
         Code::calibration_not_available, at,
         fmt::format("'{}' is never violated for good, whatever this time is, so it has no false "
                     "alarm to calibrate against",
                     monitor.name))
        .note("F and U without an upper bound wait forever; a bound helps, as in F[0, 20 s] p");
}

}  // namespace etlc::check
