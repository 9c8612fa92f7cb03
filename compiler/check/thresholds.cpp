// The thresholds file: an epsilon for every calibrated predicate, where the file was made for this spec.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "check/adaptation.hpp"
#include "check/calibrated.hpp"
#include "check/check.hpp"
#include "check/decimal.hpp"
#include "check/provenance.hpp"
#include "check/steps.hpp"
#include "data/file.hpp"
#include "thresholds/thresholds.hpp"

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

/// Reads the file; nothing, with a diagnostic, where there is none or it is damaged.
std::optional<thresholds::File> read_thresholds(Context& c, const std::string& name, const Threshold& first) {
    const bool is_default = c.options.thresholds_path.empty();
    const std::string path = is_default ? default_thresholds_path(c.file.path()) : c.options.thresholds_path;
    std::error_code error;
    if (is_default && !std::filesystem::exists(path, error)) {
        c.report(Code::thresholds_missing, first.span,
                 fmt::format("'{}' has a calibrated threshold, and there is no thresholds file {}", name, path))
            .note("'etlc calibrate' makes one from labelled demonstrations; --thresholds names another");
        return std::nullopt;
    }
    auto file = thresholds::read(path);
    if (!file) {
        c.sink.report(data::in_file(file.failure(), path))
            .note(first.span, fmt::format("the threshold of '{}' is calibrated", name));
        return std::nullopt;
    }
    c.dependencies.insert(path);
    return std::move(*file);
}

bool same_number(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a == b : Decimal::parse(a) == Decimal::parse(b);
}

/// What differs between the spec and what the entry was calibrated for, a sentence each.
class Differences {
public:
    /// `what`: predicate or formula.
    Differences(const Model& model, const Threshold& threshold, std::string_view what, Provenance now,
                const thresholds::Entry& entry)
        : model_(model), threshold_(threshold), what_(what), entry_(entry), now_(std::move(now)) {}

    std::vector<std::string> find() && {
        const std::string_view method = method_name(threshold_.origin);
        if (entry_.method != method)
            add("method", entry_.method, method);
        else if (!same_number(entry_.alpha, threshold_.alpha))
            add("alpha", entry_.alpha, threshold_.alpha);
        if (entry_.predicate != now_.predicate) add(what_, entry_.predicate, now_.predicate);
        add_changed(now_.targets);
        if (entry_.truth != "array") {
            if (entry_.truth != now_.truth)
                add("truth", entry_.truth, now_.truth.empty() ? "none" : now_.truth);
            else
                add_changed(now_.truth_targets);
        }
        return std::move(found_);
    }

private:
    void add(std::string_view what, std::string_view then, std::string_view now) {
        found_.push_back(fmt::format("the {} was: {}; it is: {}", what, trimmed(then), trimmed(now)));
    }

    static std::string_view trimmed(std::string_view text) {
        while (text.ends_with(' ')) text.remove_suffix(1);
        return text;
    }

    void add_changed(const std::map<std::string, std::string>& hashes) {
        for (const auto& [name, hash] : hashes) {
            const auto then = entry_.targets.find(name);
            // A target that the entry does not know belongs to a predicate that has changed, which has been said.
            if (then == entry_.targets.end() && found_.empty())
                found_.push_back(fmt::format("it does not say for which {} of '{}'", what_is_hashed(name), name));
            if (then != entry_.targets.end() && then->second != hash)
                found_.push_back(fmt::format("the {} of '{}' changed", what_is_hashed(name), name));
        }
    }

    std::string_view what_is_hashed(const std::string& name) const {
        const auto is_named = [&](const auto& declared) { return declared.name == name; };
        if (std::any_of(model_.targets.begin(), model_.targets.end(), is_named)) return "values";
        return std::any_of(model_.inputs.begin(), model_.inputs.end(), is_named) ? "scale" : "weights";
    }

    const Model& model_;
    const Threshold& threshold_;
    std::string_view what_;
    const thresholds::Entry& entry_;
    Provenance now_;
    std::vector<std::string> found_;
};

/// Takes epsilon from the entry of that name, where it was calibrated for what `differences` compares it with.
template <class Compare>
void take(Context& c, const std::string& name, Threshold& threshold, const std::string& path,
          const std::map<std::string, thresholds::Entry>& entries, Compare differences) {
    const auto found = entries.find(name);
    if (found == entries.end()) {
        c.report(Code::threshold_missing, threshold.span, fmt::format("{} has no threshold for '{}'", path, name))
            .note("calibrate again with 'etlc calibrate'");
        return;
    }
    const std::vector<std::string> all = differences(found->second);
    if (!all.empty()) {
        auto& error =
            c.report(Code::threshold_stale, threshold.span,
                     fmt::format("the threshold of '{}' in {} was calibrated for something else", name, path));
        for (const std::string& difference : all) error.note(difference);
        error.note("calibrate again with 'etlc calibrate'");
        return;
    }
    threshold.value = found->second.epsilon;
    threshold.value64 = static_cast<double>(found->second.epsilon);
    threshold.n = found->second.n;
    threshold.k = found->second.k;
}

void take_threshold(Context& c, Index index, const thresholds::File& file) {
    Predicate& predicate = c.model.predicates[index];
    Threshold& threshold = predicate.threshold;
    take(c, predicate.name, predicate.threshold, file.path, file.predicates, [&](const thresholds::Entry& entry) {
        return Differences(c.model, threshold, "predicate", provenance(c.model, index), entry).find();
    });
    if (!threshold.adaptation || std::isnan(threshold.value)) return;
    const auto begin = start(*threshold.adaptation, threshold.value, predicate.upper_bound());
    if (!begin) {
        c.report(Code::start_out_of_range, threshold.span, outside(predicate, threshold.value))
            .note("give it lo and hi with room on both sides of the threshold; a new calibration is not needed");
        return;
    }
    threshold.value = *begin;
    threshold.value64 = static_cast<double>(*begin);
}

void take_shift(Context& c, Monitor& monitor, const thresholds::File& file) {
    MonitorCalibration& calibration = *monitor.calibration;
    take(c, monitor.name, calibration.threshold, file.path, file.monitors, [&](const thresholds::Entry& entry) {
        auto found = Differences(c.model, calibration.threshold, "formula", provenance(c.model, monitor), entry).find();
        if (entry.against != word(calibration.against))
            found.push_back(fmt::format("it was against: {}; it is: {}", entry.against, word(calibration.against)));
        return found;
    });
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
    const auto file = predicates.empty() ? read_thresholds(c, monitors[0]->name, monitors[0]->calibration->threshold)
                                         : read_thresholds(c, c.model.predicates[predicates[0]].name,
                                                           c.model.predicates[predicates[0]].threshold);
    if (!file) return;
    const std::size_t errors = c.sink.errors();
    for (const Index index : predicates) take_threshold(c, index, *file);
    if (c.sink.errors() > errors) return;  // a monitor's shift is for the thresholds in it
    for (Monitor* monitor : monitors) take_shift(c, *monitor, *file);
}

}  // namespace etlc::check
