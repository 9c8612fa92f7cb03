#include "check/guarantees/calibrated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using diag::Code;

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
        {"conformal", ThresholdOrigin::conformal, {"alpha"}},
        {"class_conditional", ThresholdOrigin::class_conditional, {"alpha"}},
        {"adaptive", ThresholdOrigin::adaptive, {"alpha", "gamma", "lo", "hi"}},
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
void warn_of_large_alpha(Context& c, const ast::Number& alpha) {
    const Decimal value = Decimal::parse(alpha.text);
    if (!(Decimal::parse("0.5") < value)) return;
    const std::string text = shown(alpha);
    c.report(Code::large_alpha, alpha.span,
             fmt::format("alpha = {} allows more than half to be missed", text))
        .note(large_alpha_note(alpha.text));
}

bool is_alpha(Context& c, const ast::Calibrated::Argument& argument) {
    const auto* number = std::get_if<ast::Number>(&argument.value);
    const bool open_unit = number != nullptr && Decimal::parse(number->text).is_positive() &&
                           Decimal::parse(number->text) < Decimal::parse("1");
    if (open_unit) {
        warn_of_large_alpha(c, *number);
        return true;
    }
    const std::string text =
        number != nullptr ? shown(*number) : std::get<ast::Name>(argument.value).text;
    return c.refuse(Code::calibration_argument, ast::span_of(argument.value),
                    fmt::format("alpha = {}; expected a number above 0 and below 1", text));
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

/// Returns the text of alpha, empty for a method without; nothing after an error in an argument.
std::optional<std::string> alpha_of(Context& c, const ast::Calibrated& written,
                                    const Method& method) {
    const std::size_t errors = c.sink.errors();
    check_arguments(c, written, method);
    std::string alpha;
    for (const ast::Calibrated::Argument& argument : written.arguments)
        if (argument.key.text == "alpha" && !method.arguments.empty() && is_alpha(c, argument))
            alpha = std::get<ast::Number>(argument.value).text;
    if (c.sink.errors() > errors) return std::nullopt;
    if (!method.arguments.empty() && alpha.empty())
        return c.no_value(
            Code::calibration_argument, written.span,
            fmt::format("{} needs its error rate; expected {}", method.name,
                        method.origin == ThresholdOrigin::adaptive
                            ? std::string(kAdaptiveForm)
                            : fmt::format("calibrated({}, alpha = 0.1)", method.name)));
    return alpha;
}

Threshold uncalibrated(const ast::Calibrated& written, const Method& method,
                       const std::string& alpha) {
    Threshold threshold;
    threshold.origin = method.origin;
    threshold.alpha = alpha;
    threshold.text = alpha.empty() ? fmt::format("calibrated({})", method.name)
                                   : fmt::format("calibrated({}, alpha = {})", method.name, alpha);
    threshold.value64 = std::numeric_limits<double>::quiet_NaN();
    threshold.value = std::numeric_limits<float>::quiet_NaN();
    threshold.span = written.span;
    return threshold;
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
        if (argument.key.text != key) continue;
        if (const auto* number = std::get_if<ast::Number>(&argument.value)) return number;
        const ast::Name& name = std::get<ast::Name>(argument.value);
        c.report(Code::calibration_argument, name.span,
                 fmt::format("{} = {}; expected a number", key, name.text));
        return nullptr;
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

constexpr std::string_view kMonitorForm =
    "calibrated(conformal, alpha = 0.1, against = missed_alarm)";

/// Returns the value of `against`; nothing after an error.
std::optional<Against> against_of(Context& c, const ast::Calibrated::Argument& argument) {
    const auto* name = std::get_if<ast::Name>(&argument.value);
    for (const Against against : {Against::missed_alarm, Against::missed_success})
        if (name != nullptr && name->text == word(against)) return against;
    return c.no_value(Code::calibration_argument, ast::span_of(argument.value),
                      "expected against = missed_alarm or against = missed_success");
}

}  // namespace

std::string large_alpha_note(const std::string& alpha) {
    return fmt::format(
        "it is an error rate, not a coverage: to cover a share of {}, write alpha = {:.9g}", alpha,
        1 - to_double(alpha));
}

std::string_view method_name(ThresholdOrigin origin) {
    for (const Method& method : methods())
        if (method.origin == origin) return method.name;
    return "";
}

std::string_view word(Against against) {
    return against == Against::missed_alarm ? "missed_alarm" : "missed_success";
}

std::optional<MonitorCalibration> check_monitor_calibrated(Context& c,
                                                           const ast::Calibrated& written) {
    const Method* method = find_method(c, written.method);
    if (method == nullptr) return std::nullopt;
    if (method->origin != ThresholdOrigin::conformal) {
        c.report(Code::unknown_method, written.method.span,
                 fmt::format("a monitor is calibrated with 'conformal'; '{}' is for predicates",
                             method->name))
            .note(fmt::format("expected {}", kMonitorForm));
        return std::nullopt;
    }
    const Method whole{method->name, method->origin, {"alpha", "against"}};
    const std::size_t errors = c.sink.errors();
    std::optional<Against> against;
    for (const ast::Calibrated::Argument& argument : written.arguments)
        if (argument.key.text == "against") against = against_of(c, argument);
    const auto alpha = alpha_of(c, written, whole);
    if (!alpha || c.sink.errors() > errors) return std::nullopt;
    if (!against)
        return c.no_value(
            Code::calibration_argument, written.span,
            fmt::format("a monitor is calibrated against one kind of error; expected {}",
                        kMonitorForm));
    MonitorCalibration result{uncalibrated(written, *method, *alpha), *against};
    result.threshold.text =
        fmt::format("calibrated(conformal, alpha = {}, against = {})", *alpha, word(*against));
    return result;
}

std::optional<Threshold> check_calibrated(Context& c, const ast::Calibrated& written) {
    const Method* method = find_method(c, written.method);
    if (method == nullptr) return std::nullopt;
    const auto alpha = alpha_of(c, written, *method);
    if (!alpha) return std::nullopt;
    Threshold threshold = uncalibrated(written, *method, *alpha);
    if (method->origin != ThresholdOrigin::adaptive) return threshold;
    threshold.adaptation = check_adaptation(c, written, *alpha);
    if (!threshold.adaptation) return std::nullopt;
    const Adaptation& moves = *threshold.adaptation;
    threshold.text = fmt::format("calibrated(adaptive, alpha = {}, gamma = {}, lo = {}, hi = {})",
                                 *alpha, moves.gamma, moves.lo, moves.hi);
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
