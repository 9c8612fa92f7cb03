#include "check/time/time.hpp"

#include <fmt/format.h>

#include "check/context/context.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using diag::Code;

std::string_view rate_word(const ast::Rate& rate) {
    return rate.is_period ? "period" : "rate";
}

std::string_view written(const ast::Number& number) {
    return number.constant.empty() ? number.text : number.constant;
}

Quantity quantity(const ast::Rate& rate) {
    return {Decimal::parse(rate.number.text), rate.unit};
}

bool has_too_many_digits(Context& c, const ast::Number& number) {
    const std::size_t digits = Decimal::parse(number.text).digits.size();
    if (digits <= kMaxTimeDigits) return false;
    c.report(Code::time_too_precise, number.span,
             fmt::format("a time with {} significant digits; etlc computes with at most {}", digits,
                         kMaxTimeDigits));
    return true;
}

/// Accepts periods between a picosecond and about three years, since the length of a step is also a
/// double.
bool has_usable_length(Context& c, const ast::Rate& rate) {
    const double length = seconds(quantity(rate));
    if (length >= 1e-12 && length <= 1e8) return true;
    return c.refuse(
        Code::rate_out_of_range, rate.number.span,
        fmt::format("a step of {:.3g} s; expected one between 1e-12 s and 1e8 s", length));
}

bool is_usable(Context& c, const ast::Rate& rate) {
    if (has_too_many_digits(c, rate.number)) return false;
    if (!Decimal::parse(rate.number.text).is_positive())
        return c.refuse(Code::rate_out_of_range, rate.number.span,
                        fmt::format("the {} is {}; expected a positive number", rate_word(rate),
                                    shown(rate.number)));
    return has_usable_length(c, rate);
}

std::string in_words(ast::Rounding rounding) {
    return rounding == ast::Rounding::nearest ? "to the nearest" : std::string(word(rounding));
}

// ---- bounds -------------------------------------------------------------------------------------

bool is_infinite(const ast::Bound& bound) {
    return bound.number.text == "inf" || bound.number.text == "-inf";
}

/// Whether the bound has no unit and needs none: inf, or 0, which is zero steps and zero time.
bool has_no_unit_of_its_own(const ast::Bound& bound) {
    return is_infinite(bound) ||
           (bound.unit.empty() && Decimal::parse(bound.number.text).is_zero());
}

std::string bound_text(const ast::Bound& bound) {
    return with_unit(shown(bound.number), bound.unit);
}

std::nullopt_t report_too_large(Context& c, const ast::Bound& bound) {
    c.report(
         Code::bound_too_large, bound.span,
         fmt::format("{} is more than {} steps, the largest bound", bound_text(bound), kMaxBound))
        .note("without an upper bound, write [a, inf]");
    return std::nullopt;
}

std::optional<std::uint32_t> whole_steps(Context& c, const ast::Bound& bound) {
    const Decimal value = Decimal::parse(bound.number.text);
    if (value.negative || !value.is_whole()) {
        auto& error =
            c.report(Code::bound_not_whole, bound.span,
                     fmt::format("the bound {} is not a whole number of steps", bound_text(bound)));
        if (!value.negative) error.note("a duration has a unit: us, ms, s or min");
        return std::nullopt;
    }
    const auto steps = value.whole(kMaxBound);
    if (!steps) return report_too_large(c, bound);
    return static_cast<std::uint32_t>(*steps);
}

void report_not_whole(Context& c, const ast::Bound& bound, std::uint64_t below) {
    const ast::Rate& rate = *c.step.rate;
    const Quantity step = quantity(rate);
    const auto name = [&](std::uint64_t steps) {
        return fmt::format("{} ({})", duration_text(steps, step, bound.unit),
                           diag::counted(steps, "step"));
    };
    c.report(Code::duration_not_whole, bound.span,
             fmt::format("{} is not a whole number of steps; the nearest are {} and {}",
                         bound_text(bound), name(below), name(below + 1)))
        .note(rate.span,
              fmt::format("the {} is {} {}", rate_word(rate), rate.number.text, rate.unit))
        .note(
            fmt::format("to round durations, write '{} {} {}, durations up;', or down, or nearest",
                        rate_word(rate), written(rate.number), rate.unit));
}

/// Rounds a duration that is not a whole number of steps.
std::optional<std::uint32_t> rounded_steps(Context& c, const ast::Bound& bound,
                                           const StepCount& count) {
    const ast::Rate& rate = *c.step.rate;
    const bool up = rate.durations == ast::Rounding::up ||
                    (rate.durations == ast::Rounding::nearest && count.upper_half);
    const auto steps = static_cast<std::uint32_t>(count.floor + (up ? 1 : 0));
    if (steps == 0) {
        c.report(Code::duration_vanishes, bound.span,
                 fmt::format("{} is less than a step and rounds to zero steps", bound_text(bound)))
            .note(rate.span,
                  fmt::format("the {} is {} {}, and durations are rounded {}", rate_word(rate),
                              rate.number.text, rate.unit, in_words(rate.durations)));
        return std::nullopt;
    }
    c.model.rounded.emplace(bound_text(bound), steps);
    return steps;
}

std::optional<std::uint32_t> duration_steps(Context& c, const ast::Bound& bound) {
    if (c.step.broken || has_too_many_digits(c, bound.number)) return std::nullopt;
    const Decimal value = Decimal::parse(bound.number.text);
    if (value.negative)
        return c.no_value(Code::bound_not_whole, bound.span,
                          fmt::format("the bound {} is negative", bound_text(bound)));
    if (c.step.rate == nullptr) {
        if (!c.incomplete)
            c.report(Code::no_rate, bound.span,
                     fmt::format("{} is a duration, but the spec has no rate or period to define "
                                 "the length of a step",
                                 bound_text(bound)))
                .note("add a line such as 'rate 20 Hz;' or 'period 50 ms;'");
        return std::nullopt;
    }
    const StepCount count = count_steps({value, bound.unit}, quantity(*c.step.rate));
    if (count.too_many) return report_too_large(c, bound);
    if (count.whole) return static_cast<std::uint32_t>(count.floor);
    if (c.step.rate->durations != ast::Rounding::exact) return rounded_steps(c, bound, count);
    report_not_whole(c, bound, count.floor);
    return std::nullopt;
}

}  // namespace

bool is_duration(const ast::Bound& bound) {
    return !bound.unit.empty() && bound.unit != ast::kStepsUnit;
}

std::optional<std::uint32_t> bound_steps(Context& c, const ast::Bound& bound) {
    if (bound.calibrated)
        return c.no_value(
            Code::calibration_not_available, bound.span,
            "only the upper bound of an interval, and the time of held and count, can "
            "be calibrated; expected a time");
    if (bound.unit == ast::kStepsUnit) c.steps_on_purpose = true;
    if (!has_no_unit_of_its_own(bound) && bound.unit.empty())
        c.bare_bounds.emplace(bound.span.begin, &bound);
    if (is_infinite(bound)) return kUnbounded;
    return is_duration(bound) ? duration_steps(c, bound) : whole_steps(c, bound);
}

void check_rate(Context& c) {
    const ast::Rate* first = nullptr;
    for_each_declaration<ast::Rate>(c.spec, [&](const ast::Rate& rate, Index) {
        if (first == nullptr) {
            first = &rate;
            return;
        }
        c.report(
             Code::duplicate_rate, rate.span,
             fmt::format("a second {}; the length of a step is given only once", rate_word(rate)))
            .note(first->span, "it is given here");
    });
    if (first == nullptr) return;
    if (!is_usable(c, *first)) {
        c.step.broken = true;
        return;
    }
    c.step.rate = first;
    c.model.step_seconds = seconds(quantity(*first));
    if (first->durations != ast::Rounding::exact) c.model.rounding = in_words(first->durations);
}

bool is_finite_duration(Context& c, const ast::Bound& bound, std::string_view why,
                        std::string_view instead) {
    if (!is_infinite(bound)) return true;
    auto& error = c.report(Code::bound_not_finite, bound.span,
                           fmt::format("{} is not allowed here; {}", bound_text(bound), why));
    if (!instead.empty()) error.note(std::string(instead));
    return false;
}

std::optional<std::uint32_t> lower_steps(Context& c, const ast::Bound& bound) {
    if (!is_infinite(bound)) return bound_steps(c, bound);
    return c.no_value(
        Code::bound_not_finite, bound.span,
        fmt::format("{} is not allowed here; only the upper bound may be inf", bound_text(bound)));
}

std::optional<Steps> interval_steps(Context& c, const ast::Interval& interval) {
    const ast::Bound& low = interval.low;
    const ast::Bound& high = interval.high;
    if (is_infinite(low)) {
        lower_steps(c, low);
        return std::nullopt;
    }
    if (high.number.text == "-inf") {
        lower_steps(c, high);
        return std::nullopt;
    }
    if (!has_no_unit_of_its_own(low) && !has_no_unit_of_its_own(high) &&
        is_duration(low) != is_duration(high))
        return c.no_value(Code::mixed_interval, interval.span,
                          fmt::format("one bound is in steps and one is a duration: {} and {}",
                                      bound_text(low), bound_text(high)));
    const auto low_steps = bound_steps(c, low);
    const auto high_steps = bound_steps(c, high);
    if (!low_steps || !high_steps) return std::nullopt;
    if (*low_steps > *high_steps)
        return c.no_value(Code::interval_reversed, interval.span,
                          fmt::format("the lower bound {} is above the upper bound {}",
                                      bound_text(low), bound_text(high)));
    return Steps{*low_steps, *high_steps};
}

std::string interval_text(const Context& c, std::uint64_t low, std::uint64_t high) {
    const auto in_seconds = [&](std::uint64_t steps) -> std::string {
        if (steps == kUnbounded) return "inf";
        const std::string text = duration_text(steps, quantity(*c.step.rate), "s");
        return text.find_first_of("/a") == std::string::npos ? text : "";  // 100/3, about 33.3
    };
    const auto in_steps = [](std::uint64_t steps) {
        return steps == kUnbounded ? "inf" : diag::counted(steps, "step");
    };
    if (c.step.rate != nullptr) {
        const std::string from = in_seconds(low);
        const std::string to = in_seconds(high);
        if (!from.empty() && !to.empty()) return fmt::format("[{}, {}]", from, to);
    }
    return fmt::format("[{}, {}]", in_steps(low), in_steps(high));
}

void warn_of_bare_bounds(Context& c) {
    if (c.step.rate == nullptr || c.steps_on_purpose || c.bare_bounds.empty()) return;
    const ast::Rate& rate = *c.step.rate;
    const ast::Bound& first = *c.bare_bounds.begin()->second;
    const double length = seconds(quantity(rate)) * to_double(first.number.text);
    const std::string in_steps = fmt::format("{} {}", written(first.number),
                                             first.number.text == "1" ? "step" : ast::kStepsUnit);
    diag::Diagnostic& warning = c.report(
        Code::bare_bound, first.span,
        fmt::format("{} has no unit and counts steps: at the {} of {} {} that is {:.3g} s",
                    bound_text(first), rate_word(rate), rate.number.text, rate.unit, length));
    warning.note(fmt::format("write '{}' for steps, or a unit of time: '{} s'", in_steps,
                             written(first.number)));
    if (const std::size_t others = c.bare_bounds.size() - 1; others > 0)
        warning.note(fmt::format("{} without a unit; writing 'steps' once confirms all of them",
                                 diag::counted(others, "more bound")));
    warning.meant = in_steps;
}

}  // namespace etlc::check
