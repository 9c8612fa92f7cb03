// Reads the thresholds file, if it was made for this spec.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "artifacts/thresholds.hpp"
#include "check/context/context.hpp"
#include "check/context/options.hpp"
#include "check/guarantees/adaptation.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/consistency.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"

namespace etlc::check {

namespace {

using diag::Code;

std::vector<Index> calibrated_predicates(Context& c) {
    std::vector<Index> found;
    for (Index i = 0; i < c.model.predicates.size(); ++i) {
        const Predicate& predicate = c.model.predicates[i];
        const bool sound = predicate.name.empty() || !c.scope.entity(NameKind::predicate, i).broken;
        if (sound && predicate.threshold.origin != ThresholdOrigin::literal) found.push_back(i);
    }
    return found;
}

/// Reports a missing calibration, which leaves the threshold NaN.
diag::Diagnostic& report_missing(Context& c, Code code, Span span, std::string message) {
    diag::Diagnostic found{code, std::move(message), span};
    found.is_allowed = c.options.allow_missing;
    return c.sink.report(std::move(found));
}

/// Returns the given thresholds or those in the file; nothing after an error.
std::optional<thresholds::File> read_thresholds(Context& c, const std::string& name,
                                                const Threshold& first) {
    if (c.options.thresholds != nullptr) return *c.options.thresholds;
    const bool is_default = c.options.thresholds_path.empty();
    const std::string path =
        is_default ? default_thresholds_path(c.file.path()) : c.options.thresholds_path;
    std::error_code error;
    if (is_default && !std::filesystem::exists(path, error)) {
        report_missing(
            c, Code::thresholds_missing, first.span,
            fmt::format("'{}' has a calibrated threshold, but there is no thresholds file {}", name,
                        path))
            .note(
                "'etlc calibrate' makes one from labelled demonstrations; --thresholds selects "
                "another");
        return std::nullopt;
    }
    return read_made(c, path, thresholds::read, first.span,
                     fmt::format("the threshold of '{}' is calibrated", name));
}

bool same_number(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a == b : Decimal::parse(a) == Decimal::parse(b);
}

/// Lists the differences between the spec and what an entry was calibrated for.
class Differences {
public:
    /// `what` is "predicate" or "formula".
    Differences(const Model& model, const std::string& name, const Threshold& threshold,
                std::string_view what, Provenance now, const thresholds::Entry& entry)
        : model_(model),
          name_(name),
          threshold_(threshold),
          what_(what),
          entry_(entry),
          now_(std::move(now)) {}

    std::vector<std::string> find() && {
        const std::string_view method = method_name(threshold_.origin);
        if (entry_.method != method)
            add("method", entry_.method, method);
        else if (!same_number(entry_.alpha, threshold_.alpha))
            add("alpha", entry_.alpha, threshold_.alpha);
        if (entry_.predicate != now_.predicate) add(what_, entry_.predicate, now_.predicate);
        add_changed(now_.targets);
        if (stated(entry_.truth) == now_.truth)
            add_changed(now_.truth_targets);
        else
            add_labels();
        add_gone();
        if (found_.empty()) add_read();
        return std::move(found_);
    }

private:
    void add(std::string_view what, std::string_view then, std::string_view now) {
        found_.push_back(changed(fmt::format("the {}", what), trimmed(then), trimmed(now)));
    }

    static std::string_view trimmed(std::string_view text) {
        while (text.ends_with(' ')) text.remove_suffix(1);
        return text;
    }

    /// Adds a change of the truth, or between a truth and an array.
    void add_labels() {
        const std::string then = stated(entry_.truth);
        if (then == entry_.truth && !now_.truth.empty()) return add("truth", then, now_.truth);
        const auto labels = [&](std::string_view truth) {
            return truth.empty() ? fmt::format("an array truth.{} or a table", name_)
                                 : std::string(truth);
        };
        found_.push_back(fmt::format("the labels were: {}; they are: {}",
                                     labels(entry_.truth == "array" ? then : entry_.truth),
                                     labels(now_.truth)));
    }

    /// Adds differences that have no words of their own.
    void add_read() {
        if (!entry_.reads.empty())
            found_ = differences(entry_.reads, now_.reads);
        else if (what_ == "formula")
            found_.emplace_back(
                "the entry is of an earlier version, which does not record everything that it "
                "depends on");
    }

    void add_changed(const std::map<std::string, std::string>& hashes) {
        for (const auto& [name, hash] : hashes) {
            const auto then = entry_.targets.find(name);
            // An unknown target belongs to a changed predicate, which has been reported.
            if (then == entry_.targets.end() && found_.empty())
                found_.push_back(is_input(name)
                                     ? fmt::format("the declaration of '{}' changed", name)
                                     : fmt::format("it does not record the {} of '{}'",
                                                   what_is_hashed(name), name));
            if (then != entry_.targets.end() && then->second != hash)
                found_.push_back(fmt::format("the {} of '{}' changed", what_is_hashed(name), name));
        }
    }

    /// Adds what the entry was calibrated with but the spec no longer uses.
    void add_gone() {
        if (!found_.empty()) return;  // already explained
        for (const auto& [name, hash] : entry_.targets)
            if (!now_.targets.contains(name) && !now_.truth_targets.contains(name))
                found_.push_back(
                    is_input(name)
                        ? fmt::format("the declaration of '{}' changed", name)
                        : fmt::format("it was calibrated with '{}', which is no longer used",
                                      name));
    }

    template <class Thing>
    static bool has(const std::vector<Thing>& things, const std::string& name) {
        return std::any_of(things.begin(), things.end(),
                           [&](const Thing& thing) { return thing.name == name; });
    }

    bool is_input(const std::string& name) const { return has(model_.inputs, name); }

    std::string_view what_is_hashed(const std::string& name) const {
        if (has(model_.encoders, name)) return "model or settings";
        if (has(model_.targets, name) || has(model_.projections, name)) return "values";
        return is_input(name) ? "declaration" : "weights";
    }

    const Model& model_;
    const std::string& name_;
    const Threshold& threshold_;
    std::string_view what_;
    const thresholds::Entry& entry_;
    Provenance now_;
    std::vector<std::string> found_;
};

constexpr std::string_view kAgain = "calibrate again with 'etlc calibrate'";

/// Returns the entry of that name; null after an error, if it is missing or `differences` finds
/// some.
template <class Compare>
const thresholds::Entry* find_entry(Context& c, const std::string& name, const Threshold& threshold,
                                    const std::string& path,
                                    const std::map<std::string, thresholds::Entry>& entries,
                                    Compare differences) {
    const auto found = entries.find(name);
    if (found == entries.end()) {
        report_missing(c, Code::threshold_missing, threshold.span,
                       fmt::format("{} has no threshold for '{}'", path, name))
            .note(std::string(kAgain));
        return nullptr;
    }
    const bool is_current = is_up_to_date(
        c, Code::threshold_stale, threshold.span,
        fmt::format("the threshold of '{}' in {} was calibrated for something else", name, path),
        differences(found->second), kAgain);
    return is_current ? &found->second : nullptr;
}

/// Records, beside the guarantees, that labels differed from the truths in the spec.
void reserve(Context& c, const std::string& labels, const std::string& name) {
    if (labels != "array" && labels != stated(labels))
        c.model.reservations.push_back(
            fmt::format("'{}' was calibrated on labels from arrays or tables, not from its truth "
                        "in the spec",
                        name));
}

/// Sets epsilon, n and k; reports an inconsistent entry.
void take(Context& c, const thresholds::Entry& entry, const std::string& place,
          Threshold& threshold, bool upper_bound, const thresholds::File& file,
          const std::vector<std::uint64_t>& episodes) {
    if (const auto found = contradiction(entry, place, upper_bound, episodes, file.groups)) {
        auto& error = c.sink.report(
            data::in_file({Code::contradictory_thresholds, found->message}, file.path));
        error.note(threshold.span, "it is needed here");
        if (found->by_hand)
            error.note(
                "write a threshold chosen by hand into the spec, as in 'l2(z, goal) <= 0.35'");
        error.note(std::string(kAgain));
        return;
    }
    threshold.value = entry.epsilon;
    threshold.value64 = static_cast<double>(entry.epsilon);
    threshold.n = entry.n;
    threshold.k = entry.k;
    threshold.by_group =
        takes_groups(threshold.origin) && thresholds::count_groups(episodes, file.groups).any_named;
}

void take_threshold(Context& c, Index index, const thresholds::File& file) {
    Predicate& predicate = c.model.predicates[index];
    Threshold& threshold = predicate.threshold;
    const thresholds::Entry* entry =
        find_entry(c, predicate.name, threshold, file.path, file.predicates,
                   [&](const thresholds::Entry& found) {
                       return Differences(c.model, predicate.name, threshold, "predicate",
                                          provenance(c.model, index), found)
                           .find();
                   });
    if (entry == nullptr) return;
    reserve(c, entry->truth, predicate.name);
    take(c, *entry, "predicates." + predicate.name, threshold, predicate.upper_bound(), file,
         file.episodes);
    if (!threshold.adaptation || std::isnan(threshold.value)) return;
    const auto begin = start(*threshold.adaptation, threshold.value, predicate.upper_bound());
    if (!begin) {
        c.report(Code::start_out_of_range, threshold.span, outside(predicate, threshold.value))
            .note("choose lo and hi on both sides of the threshold; no new calibration is needed");
        return;
    }
    threshold.value = *begin;
    threshold.value64 = static_cast<double>(*begin);
}

void take_shift(Context& c, Monitor& monitor, const thresholds::File& file) {
    MonitorCalibration& calibration = *monitor.calibration;
    Threshold& shift = calibration.threshold;
    const thresholds::Entry* entry = find_entry(
        c, monitor.name, shift, file.path, file.monitors, [&](const thresholds::Entry& of) {
            auto found = Differences(c.model, monitor.name, shift, "formula",
                                     provenance(c.model, monitor), of)
                             .find();
            if (of.against != word(calibration.against))
                found.push_back(fmt::format("it was against: {}; it is: {}", of.against,
                                            word(calibration.against)));
            return found;
        });
    if (entry == nullptr) return;
    const std::string place = "monitors." + monitor.name;
    if (const auto shared = shared_episode(entry->episodes, file)) {
        c.sink
            .report(data::in_file(
                {Code::not_disjoint,
                 fmt::format(
                     "'{}' has '{}', which is one of 'episodes', or shares most of its content or "
                     "its group with one; the thresholds of predicates were calibrated on those",
                     place + ".episodes", data::hash_text(*shared))},
                file.path))
            .note(shift.span, "it is needed here")
            .note(
                "calibrate monitors on other episodes: thresholds look too good on those that they "
                "were calibrated on");
        return;
    }
    reserve(c, entry->truth, monitor.name);
    take(c, *entry, place, shift, calibration.against == Against::missed_alarm, file,
         entry->episodes);
}

std::vector<Monitor*> calibrated_monitors(Context& c) {
    std::vector<Monitor*> found;
    for (Monitor& monitor : c.model.monitors)
        if (monitor.calibration && monitor.formula != kNone) found.push_back(&monitor);
    return found;
}

}  // namespace

std::string default_thresholds_path(const std::string& spec_path) {
    std::filesystem::path path(spec_path);
    if (path.extension() == ".etl") path.replace_extension();
    path += ".thresholds.json";
    return path.string();
}

void check_thresholds(Context& c) {
    if (c.options.allow_uncalibrated) return;
    const std::vector<Index> predicates = calibrated_predicates(c);
    const std::vector<Monitor*> monitors =
        c.options.allow_uncalibrated_monitors ? std::vector<Monitor*>{} : calibrated_monitors(c);
    if (predicates.empty() && monitors.empty()) return;
    const auto file =
        predicates.empty()
            ? read_thresholds(c, monitors[0]->name, monitors[0]->calibration->threshold)
            : read_thresholds(c, c.model.predicates[predicates[0]].name,
                              c.model.predicates[predicates[0]].threshold);
    if (!file) return;
    for (const thresholds::Allowance& allowance : file->allowances)
        c.model.reservations.push_back(thresholds::text(allowance));
    const std::size_t errors = c.sink.errors();
    for (const Index index : predicates) take_threshold(c, index, *file);
    if (c.sink.errors() > errors) return;  // shifts depend on the thresholds of predicates
    for (Monitor* monitor : monitors) take_shift(c, *monitor, *file);
}

}  // namespace etlc::check
