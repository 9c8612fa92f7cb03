#include "lsp/answers/durations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "check/numbers/duration.hpp"

namespace etlc::lsp {

namespace {

using check::Decimal;
using check::Quantity;

constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kUsual{{{"1", "ms"},
                                                                                {"10", "ms"},
                                                                                {"20", "ms"},
                                                                                {"50", "ms"},
                                                                                {"100", "ms"},
                                                                                {"200", "ms"},
                                                                                {"0.5", "s"},
                                                                                {"1", "s"},
                                                                                {"2", "s"},
                                                                                {"5", "s"},
                                                                                {"10", "s"},
                                                                                {"30", "s"},
                                                                                {"1", "min"},
                                                                                {"5", "min"}}};

constexpr std::array<std::string_view, 4> kUnits{"us", "ms", "s", "min"};

Quantity step_of(const Analysis& analysis) {
    return {Decimal::parse(analysis.checked.step_number), analysis.checked.step_unit};
}

class Found {
public:
    void add(std::string text, std::uint64_t steps, bool rounded) {
        const bool known = std::any_of(all_.begin(), all_.end(),
                                       [&](const Duration& d) { return d.text == text; });
        if (steps == 0 || known || text.starts_with("about")) return;
        if (text.find('/') != std::string::npos) return;  // no decimal is equal to it
        all_.push_back(
            {std::move(text), (rounded ? "rounded to " : "") + diag::counted(steps, "step")});
    }
    std::vector<Duration> take() { return std::move(all_); }

private:
    std::vector<Duration> all_;
};

/// As written where it is a whole number of steps, or is rounded to one.
void add_written(Found& found, const Analysis& analysis, std::string_view number,
                 std::string_view unit, bool with_neighbours) {
    const Quantity step = step_of(analysis);
    const check::StepCount count = check::count_steps({Decimal::parse(number), unit}, step);
    if (count.too_many) return;
    const std::string text = check::with_unit(number, unit);
    const std::string& rounding = analysis.checked.model.rounding;
    if (count.whole) return found.add(text, count.floor, false);
    if (!rounding.empty()) {
        const bool up = rounding == "up" || (rounding == "to the nearest" && count.upper_half);
        return found.add(text, count.floor + (up ? 1 : 0), true);
    }
    if (!with_neighbours || count.floor == 0) return;
    for (const std::uint64_t steps : {count.floor, count.floor + 1})
        found.add(check::duration_text(steps, step, unit), steps, false);
}

}  // namespace

std::vector<Duration> durations(const Analysis& analysis) {
    if (analysis.checked.step_number.empty()) return {};
    Found found;
    for (const auto& [number, unit] : kUsual) add_written(found, analysis, number, unit, false);
    return found.take();
}

std::vector<Duration> durations_near(const Analysis& analysis, const std::string& number) {
    if (analysis.checked.step_number.empty()) return {};
    if (Decimal::parse(number).digits.size() > check::kMaxTimeDigits) return {};
    Found found;
    for (const std::string_view unit : kUnits) add_written(found, analysis, number, unit, true);
    return found.take();
}

}  // namespace etlc::lsp
