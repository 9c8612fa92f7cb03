#include "driver/commands/measurements.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <utility>

#include "source/text.hpp"

namespace etlc::driver {

using check::Index;

std::string csv_line(std::vector<std::string> cells) {
    for (std::string& cell : cells) cell = source::csv_cell(cell);
    return fmt::format("{}\n", fmt::join(cells, ","));
}

std::string measured_name(const check::Model& model, Index p, std::size_t number) {
    const std::string& name = model.predicates[p].name;
    return name.empty() ? fmt::format("comparison_{}", number) : "distance_" + name;
}

namespace {

/// Returns " in [0, inf]", the range that bounds over continuations depend on.
std::string range_of(const check::Predicate& predicate) {
    const auto [low, high] = predicate.delta;
    if (std::isinf(low) && std::isinf(high)) return "";
    return fmt::format(" in [{}, {}]", low, high);
}

/// Returns "distance_near <= 0.35", and what follows the threshold in the spec.
std::string comparison(const check::Model& model, const check::Predicate& predicate,
                       const std::string& input) {
    const std::string_view text = predicate.text;  // "min l2(z, goal) <= "
    const std::size_t end = text.find_last_not_of(' ') + 1;
    const std::string_view sign = text.substr(0, end).substr(text.rfind(' ', end - 1) + 1);
    const std::uint32_t behind = predicate.threshold.span.end;
    const bool is_written = behind > predicate.span.begin;
    return fmt::format("{} {} {}{}", input, sign, predicate.threshold.value,
                       is_written ? model.file.text(source::Span{behind, predicate.span.end}) : "");
}

/// Replacements by their place in the spec.
using Changes = std::map<std::uint32_t, std::pair<source::Span, std::string>>;

/// Replaces a predicate; a comparison without a name may occur in several formulas.
void change_everywhere(Changes& changes, const check::Model& model, Index p,
                       const std::string& text) {
    const check::Predicate& predicate = model.predicates[p];
    if (!predicate.name.empty()) {
        changes[predicate.span.begin] = {predicate.span,
                                         "predicate " + predicate.name + " = " + text};
        return;
    }
    for (const check::Formula& formula : model.formulas)
        if (formula.kind == check::Formula::Kind::predicate && formula.index == p)
            changes[formula.span.begin] = {formula.span, text};
}

}  // namespace

std::string measured_spec(const plan::Plan& plan) {
    const check::Model& model = *plan.model;
    Changes changes;
    std::string inputs;
    std::size_t number = 0;
    for (const Index p : plan.predicates) {
        const check::Predicate& predicate = model.predicates[p];
        const std::string input = measured_name(model, p, ++number);
        inputs += fmt::format("input {} : f32{};\n", input, range_of(predicate));
        change_everywhere(changes, model, p, comparison(model, predicate, input));
    }
    for (const plan::Monitor& monitor : plan.monitors)
        if (monitor.shifted) {
            const source::Span clause = model.monitors[monitor.index].calibration->threshold.span;
            changes[clause.begin] = {
                clause, fmt::format("/* calibrated as a whole: less by {} */", monitor.shift)};
        }
    std::string text;
    std::uint32_t copied = 0;
    const auto end = static_cast<std::uint32_t>(model.file.text().size());
    for (const auto& [begin, change] : changes) {
        text += model.file.text({copied, begin});
        text += change.second;
        copied = change.first.end;
    }
    text += model.file.text({copied, end});
    return text + (text.ends_with("\n") ? "" : "\n") + inputs;
}

}  // namespace etlc::driver
