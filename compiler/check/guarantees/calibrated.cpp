#include "check/guarantees/calibrated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "check/guarantees/adaptation.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using diag::Code;

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

}  // namespace etlc::check
