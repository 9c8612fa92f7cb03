// Reads the thresholds file, if it was made for this spec.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "artifacts/thresholds.hpp"
#include "check/context/context.hpp"
#include "check/context/options.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/guarantees/drift.hpp"
#include "check/guarantees/provenance.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/traces/overlap.hpp"

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
            fmt::format("'{}' is calibrated, but there is no thresholds file {}", name, path))
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

/// Returns the differences between what an entry was calibrated for and `now`.
std::vector<std::string> changes(const Threshold& threshold, const thresholds::Entry& entry,
                                 const Reads& now) {
    std::vector<std::string> found;
    const std::string_view method = method_name(threshold.origin);
    if (entry.method != method)
        found.push_back(changed("the method", entry.method, method));
    else if (!same_number(entry.alpha, threshold.alpha))
        found.push_back(changed("the alpha", entry.alpha, threshold.alpha));
    else if (!same_number(entry.beta, threshold.beta))
        found.push_back(changed("the beta", entry.beta.empty() ? "alpha" : entry.beta,
                                threshold.beta.empty() ? "alpha" : threshold.beta));
    const std::string against = entry.against.empty() ? "misses" : entry.against;
    if (against != word(threshold.against))
        found.push_back(
            fmt::format("it was against: {}; it is: {}", against, word(threshold.against)));
    if (entry.within != threshold.within)
        found.push_back(changed("within", diag::counted(entry.within, "step"),
                                diag::counted(threshold.within, "step")));
    const std::vector<std::string> read = differences(entry.reads, now);
    found.insert(found.end(), read.begin(), read.end());
    return found;
}

constexpr std::string_view kAgain = "calibrate again with 'etlc calibrate'";

/// Returns the entry of that name; null after an error, if it is missing or was calibrated for
/// something else.
const thresholds::Entry* find_entry(Context& c, const std::string& name, const Threshold& threshold,
                                    const std::string& path,
                                    const std::map<std::string, thresholds::Entry>& entries,
                                    const Reads& now) {
    const auto found = entries.find(name);
    if (found == entries.end()) {
        report_missing(c, Code::threshold_missing, threshold.span,
                       fmt::format("{} has no threshold for '{}'", path, name))
            .note(std::string(kAgain));
        return nullptr;
    }
    const thresholds::Entry& entry = found->second;
    const bool is_current = is_up_to_date(
        c, Code::threshold_stale, threshold.span,
        fmt::format("the threshold of '{}' in {} was calibrated for something else", name, path),
        changes(threshold, entry, now), kAgain);
    if (!is_current) return nullptr;
    if (replaces_truths(entry.reads))
        c.model.reservations.push_back(
            fmt::format("'{}' was calibrated on labels from arrays or tables, not from its truth "
                        "in the spec",
                        name));
    return &entry;
}

/// Sets epsilon, n and k; reports an inconsistent entry.
void take(Context& c, const thresholds::Entry& entry, const std::string& place,
          Threshold& threshold, bool upper_bound, const thresholds::File& file,
          const std::vector<std::uint64_t>& episodes) {
    const auto& predicates = c.model.predicates;
    const bool of_bools = std::all_of(predicates.begin(), predicates.end(),
                                      [](const Predicate& p) { return p.inputs.empty(); });
    if (const auto found =
            contradiction(entry, place, upper_bound, episodes, file.groups, of_bools)) {
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
    if (entry.inner) {
        const Both found = both(entry.epsilon, entry.inner->epsilon, upper_bound);
        threshold.value = found.value;
        threshold.inner = found.inner;
        threshold.inner_n = entry.inner->n;
        threshold.inner_k = entry.inner->k;
    }
    threshold.value64 = static_cast<double>(threshold.value);
    threshold.n = entry.n;
    threshold.k = entry.k;
    threshold.by_group =
        takes_groups(entry.method) && thresholds::count_groups(episodes, file.groups).any_named;
}

void take_threshold(Context& c, Index index, const thresholds::File& file) {
    Predicate& predicate = c.model.predicates[index];
    Threshold& threshold = predicate.threshold;
    const thresholds::Entry* entry =
        find_entry(c, predicate.name, threshold, file.path, file.predicates, reads(c.model, index));
    if (entry == nullptr) return;
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

/// Returns one of `episodes` that the file's predicates were calibrated on, or that shares most of
/// its content or its group with one of those without permission; nothing if there is none.
std::optional<std::uint64_t> shared_episode(const std::vector<std::uint64_t>& episodes,
                                            const thresholds::File& file) {
    const auto sorted = [](std::vector<std::uint64_t> hashes) {
        std::sort(hashes.begin(), hashes.end());
        return hashes;
    };
    const std::vector<std::uint64_t> known = sorted(file.episodes);
    const std::vector<std::uint64_t> asked = sorted(episodes);
    using Content = data::EpisodeContent;

    data::Suspects suspects(false);
    file.recordings.for_each_of(known,
                                [&](std::uint64_t, const Content& of) { suspects.know(of); });
    file.recordings.for_each_of(asked, [&](std::uint64_t, const Content& of) { suspects.ask(of); });
    const std::vector<bool> is_suspect = suspects.find();
    auto next = is_suspect.begin();
    data::Recordings recordings;
    file.recordings.for_each_of(known, [&](std::uint64_t, const Content& content) {
        if (*next++) recordings.add(content);
    });
    std::vector<std::uint64_t> overlapping;  // ascending
    file.recordings.for_each_of(asked, [&](std::uint64_t hash, const Content& content) {
        const auto overlap = *next++ ? recordings.find(content) : std::nullopt;
        if (overlap && (overlap->equal || file.allowances.empty())) overlapping.push_back(hash);
    });
    const auto group_of = [&](std::uint64_t episode) {
        const auto group = file.groups.find(data::hash_text(episode));
        return group == file.groups.end() ? std::string() : group->second;
    };
    std::set<std::string> groups;
    for (const std::uint64_t episode : known) groups.insert(group_of(episode));
    groups.erase("");
    const auto found = std::find_if(episodes.begin(), episodes.end(), [&](std::uint64_t episode) {
        return std::binary_search(known.begin(), known.end(), episode) ||
               std::binary_search(overlapping.begin(), overlapping.end(), episode) ||
               (file.allowances.empty() && groups.contains(group_of(episode)));
    });
    return found != episodes.end() ? std::optional(*found) : std::nullopt;
}

Threshold& calibration_of(Monitor& monitor) {
    return monitor.duration ? monitor.duration->threshold : *monitor.calibration;
}

/// Sets the duration in the formula; reports an inconsistent entry.
void take_duration(Context& c, Monitor& monitor, const thresholds::Entry& entry,
                   const std::string& place, const thresholds::File& file) {
    Duration& duration = *monitor.duration;
    const std::size_t errors = c.sink.errors();
    take(c, entry, place, duration.threshold, duration.longer_is_truer, file, entry.episodes);
    if (c.sink.errors() > errors) return;
    if (*entry.duration < duration.least || *entry.duration > duration.greatest) {
        c.sink
            .report(data::in_file(
                {Code::contradictory_thresholds,
                 fmt::format("'{}.duration' is {}, expected a number of steps from {} to {}", place,
                             *entry.duration, duration.least, duration.greatest)},
                file.path))
            .note(duration.threshold.span, "it is needed here");
        return;
    }
    duration.steps = static_cast<std::uint32_t>(*entry.duration);
    duration.is_known = true;
    set_duration(c.model, monitor, duration.steps);
}

/// Sets the shift or the duration of a monitor.
void take_of_monitor(Context& c, Monitor& monitor, const thresholds::File& file) {
    Threshold& shift = calibration_of(monitor);
    const thresholds::Entry* entry =
        find_entry(c, monitor.name, shift, file.path, file.monitors, reads(c.model, monitor));
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
    if (monitor.duration)
        take_duration(c, monitor, *entry, place, file);
    else
        take(c, *entry, place, shift, false, file, entry->episodes);
}

std::vector<Monitor*> calibrated_monitors(Context& c) {
    std::vector<Monitor*> found;
    for (Monitor& monitor : c.model.monitors)
        if ((monitor.calibration || monitor.duration) && monitor.formula != kNone)
            found.push_back(&monitor);
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
    const auto file = predicates.empty()
                          ? read_thresholds(c, monitors[0]->name, calibration_of(*monitors[0]))
                          : read_thresholds(c, c.model.predicates[predicates[0]].name,
                                            c.model.predicates[predicates[0]].threshold);
    if (!file) return;
    for (const thresholds::Allowance& allowance : file->allowances)
        c.model.reservations.push_back(thresholds::text(allowance));
    const std::size_t errors = c.sink.errors();
    for (const Index index : predicates) take_threshold(c, index, *file);
    if (c.sink.errors() > errors) return;  // those of monitors depend on these
    for (Monitor* monitor : monitors) take_of_monitor(c, *monitor, *file);
    if (c.sink.errors() > errors) return;
    for (Index d = 0; d < c.model.drifts.size(); ++d) {
        Drift& drift = c.model.drifts[d];
        const bool has_scores = drift.monitor == kNone || !monitors.empty();
        if (has_scores && !c.scope.entity(NameKind::drift, d).broken) take_drift(c, drift, *file);
    }
}

}  // namespace etlc::check
