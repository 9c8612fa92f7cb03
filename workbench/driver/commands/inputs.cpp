// The names of inputs and the files of a call.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "driver/commands/commands.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"

namespace etlc::driver {

check::Options without_results(check::Options options) {
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    options.allow_unfitted = true;
    return options;
}

bool check_names(const std::vector<const check::Model*>& models,
                 const recordings::NamesInFile& names, diag::Sink& sink) {
    std::vector<std::string> known;
    for (const check::Model* model : models) {
        for (const check::Input& input : model->inputs) known.push_back(input.name);
        for (const check::Predicate& predicate : model->predicates)
            if (!predicate.name.empty()) known.push_back("truth." + predicate.name);
    }
    bool sound = true;
    for (const auto& [name, in_file] : names) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string message =
            fmt::format("{} input {}", models.size() == 1 ? "the spec has no" : "no spec has an",
                        data::in_quotes(name)) +
            data::suggestion(name, known);
        sink.report(data::in_file({diag::Code::no_such_channel, message},
                                  fmt::format("--map {}={}", name, in_file)));
        sound = false;
    }
    return sound;
}

bool read_labels(const std::vector<const check::Model*>& models, const Request& request,
                 const std::vector<std::string>& episodes, episodes::ReadOptions& reading,
                 diag::Sink& sink) {
    episodes::LabelSources sources = request.labels;
    sources.has_episodes = request.merged == nullptr;
    reading.labels = episodes::LabelSet::read(sources, models, episodes, sink);
    return !sink.has_errors();
}

std::vector<std::string> files_read(const check::Model& model, const source::File& spec,
                                    const std::vector<std::string>& recordings,
                                    const episodes::ReadOptions& reading) {
    std::vector<std::string> files;
    if (reading.labels) files = reading.labels->tables();
    files.insert(files.end(), model.dependencies.begin(), model.dependencies.end());
    files.push_back(spec.path());
    for (const std::string& recording : recordings) files.push_back(data::trace_file(recording));
    return files;
}

std::vector<std::string_view> split_lines(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return lines;
}

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
    // No literal says two thresholds.
    const std::string inner =
        predicate.threshold.inner
            ? fmt::format(" /* true only {} {} */", predicate.upper_bound() ? "up to" : "from",
                          *predicate.threshold.inner)
            : "";
    return fmt::format("{} {} {}{}{}", input, sign, predicate.threshold.value, inner,
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
            const source::Span clause = model.monitors[monitor.index].calibration->span;
            changes[clause.begin] = {
                clause, fmt::format("/* calibrated as a whole: less by {}{} */", monitor.shift,
                                    monitor.inner_shift
                                        ? fmt::format(", its low end by {}", *monitor.inner_shift)
                                        : "")};
        }
    for (const plan::Monitor& monitor : plan.monitors)
        if (const auto& duration = model.monitors[monitor.index].duration)
            changes[duration->threshold.span.begin] = {duration->threshold.span,
                                                       diag::counted(duration->steps, "step")};
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
