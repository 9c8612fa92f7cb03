#include "check/guarantees/adaptation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using diag::Code;

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

}  // namespace

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
