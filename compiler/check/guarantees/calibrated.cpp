#include "check/guarantees/calibrated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "check/numbers/decimal.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using diag::Code;

constexpr std::string_view kMonitorForm =
    "calibrated(conformal, alpha = 0.1, against = missed_alarm)";
constexpr std::string_view kAdaptiveForm =
    "calibrated(adaptive, alpha = 0.1, gamma = 0.01, lo = 0.1, hi = 0.6)";

struct Method {
    std::string_view name;
    ThresholdOrigin origin;
    std::vector<std::string> arguments;
};

const std::vector<Method>& methods() {
    static const std::vector<Method> all{
        {"f1", ThresholdOrigin::f1, {}},
        {"conformal", ThresholdOrigin::conformal, {"alpha", "beta", "against", "within"}},
        {"class_conditional", ThresholdOrigin::class_conditional, {"alpha"}},
        {"adaptive", ThresholdOrigin::adaptive, {"alpha", "gamma", "lo", "hi"}},
        {"risk", ThresholdOrigin::risk, {"alpha", "beta", "against", "within"}},
        {"normal", ThresholdOrigin::normal, {"alpha"}},
    };
    return all;
}

const Method* find_method(Context& c, const ast::Name& name) {
    std::vector<std::string> names;
    for (const Method& method : methods()) {
        if (method.name == name.text) return &method;
        names.emplace_back(method.name);
    }
    report_unknown_word(c, Code::unknown_method, name, "is not a calibration method", names);
    return nullptr;
}

/// An alpha of 0.9, meant as coverage, gives thresholds that look good and miss nearly everything.
void warn_of_large_rate(Context& c, const std::string& key, const ast::Number& rate) {
    const Decimal value = Decimal::parse(rate.text);
    if (!(Decimal::parse("0.5") < value)) return;
    c.report(Code::large_alpha, rate.span,
             fmt::format("{} = {} allows more than half to be {}", key, shown(rate),
                         key == "alpha" ? "missed" : "false positives"))
        .note(large_alpha_note(rate.text, key));
}

/// Returns the text of a number or time as written.
std::string text_of(const std::variant<ast::Bound, ast::Name>& value) {
    const auto* const bound = std::get_if<ast::Bound>(&value);
    return bound != nullptr ? with_unit(shown(bound->number), bound->unit)
                            : std::get<ast::Name>(value).text;
}

/// Returns the number; null after an error if it is a word or has a unit.
const ast::Number* number_in(Context& c, const ast::Calibrated::Argument& argument,
                             std::string_view expected) {
    const auto* const bound = std::get_if<ast::Bound>(&argument.value);
    if (bound != nullptr && bound->unit.empty()) return &bound->number;
    c.report(
        Code::calibration_argument, ast::span_of(argument.value),
        fmt::format("{} = {}; expected {}", argument.key.text, text_of(argument.value), expected));
    return nullptr;
}

/// Returns the text of alpha or beta; empty after an error.
std::string rate_of(Context& c, const ast::Calibrated::Argument& argument) {
    constexpr std::string_view kExpected = "a number above 0 and below 1";
    const ast::Number* const number = number_in(c, argument, kExpected);
    if (number == nullptr) return {};
    const Decimal value = Decimal::parse(number->text);
    if (!value.is_positive() || !(value < Decimal::parse("1"))) {
        c.report(Code::calibration_argument, number->span,
                 fmt::format("{} = {}; expected {}", argument.key.text, shown(*number), kExpected));
        return {};
    }
    warn_of_large_rate(c, argument.key.text, *number);
    return number->text;
}

/// Returns the value of `against`; nothing after an error.
std::optional<Against> against_of(Context& c, const ast::Calibrated::Argument& argument,
                                  const std::vector<Against>& known) {
    const auto* name = std::get_if<ast::Name>(&argument.value);
    std::vector<std::string> expected;
    for (const Against against : known) {
        if (name != nullptr && name->text == word(against)) return against;
        expected.push_back(fmt::format("against = {}", word(against)));
    }
    return c.no_value(Code::calibration_argument, ast::span_of(argument.value),
                      fmt::format("expected {}", diag::alternatives(expected)));
}

/// Returns the number of steps of `within`; 0 after an error.
std::uint32_t within_of(Context& c, const ast::Calibrated::Argument& argument) {
    const auto* const bound = std::get_if<ast::Bound>(&argument.value);
    const std::size_t errors = c.sink.errors();
    const std::uint32_t steps = bound == nullptr ? 0 : bound_steps(c, *bound).value_or(0);
    if (steps == 0 && c.sink.errors() == errors)
        c.report(Code::calibration_argument, ast::span_of(argument.value),
                 fmt::format("within = {}; expected a time of at least one step",
                             text_of(argument.value)));
    return steps;
}

/// Checks that the arguments are those of the method, each at most once.
void check_arguments(Context& c, const ast::Calibrated& written, const Method& method) {
    std::set<std::string_view> given;
    for (const ast::Calibrated::Argument& argument : written.arguments) {
        const std::string& key = argument.key.text;
        const auto& known = method.arguments;
        if (std::find(known.begin(), known.end(), key) == known.end())
            c.report(Code::calibration_argument, argument.key.span,
                     known.empty() ? fmt::format("{} has no arguments", method.name)
                                   : fmt::format("{} has no argument '{}'; expected {}",
                                                 method.name, key, diag::alternatives(known)));
        else if (!given.insert(key).second)
            c.report(Code::calibration_argument, argument.key.span,
                     fmt::format("{} is given twice", key));
    }
}

/// Returns canonical text: "calibrated(conformal, alpha = 0.1, against = both)".
std::string text_of(const Threshold& threshold) {
    std::string text = fmt::format("calibrated({}", method_name(threshold.origin));
    if (!threshold.alpha.empty()) text += ", alpha = " + threshold.alpha;
    if (!threshold.beta.empty()) text += ", beta = " + threshold.beta;
    if (threshold.against != Against::misses && threshold.origin != ThresholdOrigin::normal)
        text += fmt::format(", against = {}", word(threshold.against));
    if (threshold.within > 0) text += ", within = " + diag::counted(threshold.within, "step");
    return text + ")";
}

/// Returns the threshold without its number; nothing after an error. `known`: the errors that it
/// may be against, the first of which is meant where the spec says nothing.
std::optional<Threshold> uncalibrated(Context& c, const ast::Calibrated& written,
                                      const Method& method, const std::vector<Against>& known) {
    const std::size_t errors = c.sink.errors();
    check_arguments(c, written, method);
    Threshold result;
    result.origin = method.origin;
    result.value64 = std::numeric_limits<double>::quiet_NaN();
    result.value = std::numeric_limits<float>::quiet_NaN();
    result.span = written.span;
    result.against = known.front();
    const ast::Calibrated::Argument* beta = nullptr;
    for (const ast::Calibrated::Argument& argument : written.arguments) {
        const std::string& key = argument.key.text;
        const auto& taken = method.arguments;
        if (std::find(taken.begin(), taken.end(), key) == taken.end()) continue;
        if (key == "alpha") result.alpha = rate_of(c, argument);
        if (key == "beta") result.beta = rate_of(c, *(beta = &argument));
        if (key == "within") result.within = within_of(c, argument);
        if (key == "against")
            if (const auto against = against_of(c, argument, known)) result.against = *against;
    }
    if (c.sink.errors() > errors) return std::nullopt;
    if (!method.arguments.empty() && result.alpha.empty())
        return c.no_value(
            Code::calibration_argument, written.span,
            fmt::format("{} needs its error rate; expected {}", method.name,
                        method.origin == ThresholdOrigin::adaptive
                            ? std::string(kAdaptiveForm)
                            : fmt::format("calibrated({}, alpha = 0.1)", method.name)));
    if (beta != nullptr && result.against != Against::both)
        return c.no_value(Code::calibration_argument, beta->key.span,
                          "beta is the rate of the second error; without 'against = both' there "
                          "is one, and its rate is alpha");
    result.text = text_of(result);
    return result;
}

// ---- thresholds that follow delayed labels: updates never round, so the bound on the miss rate
// (docs/calibration.md) holds for the float32 numbers
// ----------------------------------------------

/// With fewer grid lengths in a step, the tracked error rate would differ from alpha by more than
/// 1/64 of it.
constexpr double kLeastSteps = 64;

/// Some hardware flushes multiples of a smaller grid to zero.
constexpr double kLeastGrid = 0x1p-126;

/// Returns the argument's number; null if it is missing, or after an error if it is no number.
const ast::Number* number_of(Context& c, const ast::Calibrated& written, std::string_view key,
                             std::vector<std::string_view>& missing) {
    for (const ast::Calibrated::Argument& argument : written.arguments) {
        if (argument.key.text == key) return number_in(c, argument, "a number");
    }
    missing.push_back(key);
    return nullptr;
}

/// Sets [lo, hi] and the grid, which is that of the float32 numbers in the greater half of the
/// range.
bool set_range(Adaptation& result) {
    const float low = round_down(result.lo);
    const float high = round_up(result.hi);
    const double grid = std::ldexp(1.0, std::ilogb(std::max(std::abs(low), std::abs(high))) - 23);
    if (grid < kLeastGrid) return false;
    result.grid = static_cast<float>(grid);
    // Rounded outward, like all ranges; adding 0 avoids -0.
    result.range = {static_cast<float>(std::floor(static_cast<double>(low) / grid) * grid + 0.0),
                    static_cast<float>(std::ceil(static_cast<double>(high) / grid) * grid + 0.0)};
    return true;
}

/// Whether gamma, alpha and their products are exact in double.
bool exact(const std::string& gamma, const std::string& alpha) {
    const double g = to_double(gamma);
    const double a = to_double(alpha);
    const double rest = 1 - a;
    return Decimal::of(g) == Decimal::parse(gamma) && Decimal::of(a) == Decimal::parse(alpha) &&
           (1 - rest) - a == 0 && std::fma(g, a, -(g * a)) == 0 &&
           std::fma(g, rest, -(g * rest)) == 0;
}

/// Rounds a miss up from gamma (1 - alpha) and a hit down from gamma alpha, so that the miss rate
/// is at most alpha.
void set_steps(Adaptation& result, const std::string& alpha) {
    const double gamma = to_double(result.gamma);
    const double rate = to_double(alpha);
    const auto grid = static_cast<double>(result.grid);
    const double margin = exact(result.gamma, alpha) ? 0 : 1e-14;  // more than a few roundings
    result.widen = static_cast<float>(std::ceil(gamma * (1 - rate) / grid * (1 + margin)) * grid);
    result.tighten = static_cast<float>(std::floor(gamma * rate / grid * (1 - margin)) * grid);
}

/// Returns how the threshold moves; nothing after an error in gamma, lo or hi. `alpha` is valid.
std::optional<Adaptation> check_adaptation(Context& c, const ast::Calibrated& written,
                                           const std::string& alpha) {
    std::vector<std::string_view> missing;
    const ast::Number* gamma = number_of(c, written, "gamma", missing);
    const ast::Number* lo = number_of(c, written, "lo", missing);
    const ast::Number* hi = number_of(c, written, "hi", missing);
    if (!missing.empty())
        c.report(
            Code::calibration_argument, written.span,
            fmt::format("adaptive needs {}; expected {}", fmt::join(missing, ", "), kAdaptiveForm));
    if (gamma == nullptr || lo == nullptr || hi == nullptr) return std::nullopt;
    const std::size_t errors = c.sink.errors();
    for (const ast::Number* number : {gamma, lo, hi})
        number32(c, *number);  // reports numbers too large for float32
    if (c.sink.errors() > errors) return std::nullopt;
    const auto refuse = [&](const ast::Number& at,
                            std::string message) -> std::optional<Adaptation> {
        return c.no_value(Code::calibration_argument, at.span, std::move(message));
    };
    if (!Decimal::parse(gamma->text).is_positive())
        return refuse(*gamma, fmt::format("gamma = {}; expected a number above 0", gamma->text));
    if (!(Decimal::parse(lo->text) < Decimal::parse(hi->text)))
        return refuse(*hi, fmt::format("lo = {} is not below hi = {}", lo->text, hi->text));

    Adaptation result;
    result.gamma = gamma->text;
    result.lo = lo->text;
    result.hi = hi->text;
    if (!set_range(result))
        return refuse(*hi, fmt::format("the range [{}, {}] is too small for steps in float32",
                                       lo->text, hi->text));
    const double length = to_double(hi->text) - to_double(lo->text);
    if (to_double(gamma->text) > length)
        return refuse(
            *gamma,
            fmt::format("gamma = {} is longer than [{}, {}]: a single miss would cross the range",
                        gamma->text, lo->text, hi->text));
    set_steps(result, alpha);
    const double least = kLeastSteps * static_cast<double>(result.grid);
    if (static_cast<double>(result.tighten) < least)
        return refuse(
            *gamma,
            fmt::format(
                "gamma = {} is too small for float32 near {}: with alpha = {} it has to be at "
                "least {:.2g}",
                gamma->text,
                std::abs(result.range.low) > std::abs(result.range.high) ? lo->text : hi->text,
                alpha, (least + static_cast<double>(result.grid)) / to_double(alpha) * 1.05));
    return result;
}

}  // namespace

std::string large_alpha_note(const std::string& alpha, std::string_view key) {
    return fmt::format(
        "it is an error rate, not a coverage: to cover a share of {}, write {} = {:.9g}", alpha,
        key, 1 - to_double(alpha));
}

std::string_view method_name(ThresholdOrigin origin) {
    for (const Method& method : methods())
        if (method.origin == origin) return method.name;
    return "";
}

std::string_view word(Against against) {
    switch (against) {
        case Against::misses: return "misses";
        case Against::false_positives: return "false_positives";
        case Against::missed_alarm: return "missed_alarm";
        case Against::missed_success: return "missed_success";
        case Against::both: break;
    }
    return "both";
}

std::optional<Threshold> check_monitor_calibrated(Context& c, const ast::Calibrated& written) {
    const Method* method = find_method(c, written.method);
    if (method == nullptr) return std::nullopt;
    if (method->origin == ThresholdOrigin::normal)
        return uncalibrated(c, written, *method, {Against::missed_success});
    if (method->origin != ThresholdOrigin::conformal && method->origin != ThresholdOrigin::risk) {
        c.report(Code::unknown_method, written.method.span,
                 fmt::format("a monitor is calibrated with 'conformal', 'risk' or 'normal'; '{}' "
                             "is for predicates",
                             method->name))
            .note(fmt::format("expected {}", kMonitorForm));
        return std::nullopt;
    }
    const auto result = uncalibrated(
        c, written, *method, {Against::missed_alarm, Against::missed_success, Against::both});
    const auto& all = written.arguments;
    const bool is_against = std::any_of(all.begin(), all.end(), [](const auto& argument) {
        return argument.key.text == "against";
    });
    if (!result || is_against) return result;
    return c.no_value(
        Code::calibration_argument, written.span,
        fmt::format("a monitor is calibrated against one kind of error, or both; expected {}",
                    kMonitorForm));
}

std::optional<Threshold> check_duration_calibrated(Context& c, const ast::Calibrated& written) {
    static const Method conformal{"conformal", ThresholdOrigin::conformal, {"alpha"}};
    if (written.method.text == conformal.name)
        return uncalibrated(c, written, conformal, {Against::misses});
    c.report(Code::unknown_method, written.method.span,
             fmt::format("'{}' is no method for a duration; expected calibrated(conformal, alpha = "
                         "0.1)",
                         written.method.text));
    return std::nullopt;
}

std::optional<Threshold> check_calibrated(Context& c, const ast::Calibrated& written) {
    const Method* method = find_method(c, written.method);
    if (method == nullptr) return std::nullopt;
    auto threshold = uncalibrated(c, written, *method,
                                  {Against::misses, Against::false_positives, Against::both});
    if (!threshold || method->origin != ThresholdOrigin::adaptive) return threshold;
    threshold->adaptation = check_adaptation(c, written, threshold->alpha);
    if (!threshold->adaptation) return std::nullopt;
    const Adaptation& moves = *threshold->adaptation;
    threshold->text = fmt::format("calibrated(adaptive, alpha = {}, gamma = {}, lo = {}, hi = {})",
                                  threshold->alpha, moves.gamma, moves.lo, moves.hi);
    return threshold;
}

std::optional<float> start(const Adaptation& adaptation, float epsilon, bool upper_bound) {
    if (!adaptation.range.contains(epsilon)) return std::nullopt;
    const auto grid = static_cast<double>(adaptation.grid);
    const double steps = static_cast<double>(epsilon) / grid;
    return static_cast<float>((upper_bound ? std::ceil(steps) : std::floor(steps)) * grid + 0.0);
}

std::string outside(const Predicate& predicate, float epsilon) {
    const Adaptation& adaptation = *predicate.threshold.adaptation;
    return fmt::format("the calibrated threshold {:.9g} of '{}' is outside its range [{}, {}]",
                       epsilon, predicate.name, adaptation.lo, adaptation.hi);
}

}  // namespace etlc::check
