// Prints the head of the generated file: its contents and their cost, with the figures of --emit
// report.
#include <algorithm>

#include "check/guarantees/guarantees.hpp"
#include "check/model/fingerprint.hpp"
#include "diag/diag.hpp"
#include "emit/context.hpp"
#include "emit/text/layout.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::emit {

namespace {

using check::Index;

/// Returns the prefix without its blanks at the end.
std::string blank(const std::string& prefix) {
    return prefix.substr(0, prefix.find_last_not_of(' ') + 1);
}

/// Prints sentences without indentation.
void print_sentences(Printer& out, const std::string& prefix, std::string_view text) {
    print_comment(out, is_comment(prefix) ? "//" : prefix.substr(1), text);
}

/// Returns whether some sets have another size on machines without vectors.
bool laid_out_by_machine(const plan::Plan& plan) {
    return plan.cost.target_bytes != plan.cost.scalar_target_bytes;
}

Row cost_row(Row row, const plan::Cost& cost, bool both_layouts) {
    row.push_back(number(cost.state_bytes));
    row.push_back(number(cost.target_bytes));
    if (both_layouts) row.push_back(number(cost.scalar_target_bytes));
    row.push_back(number(cost.operations));
    row.push_back(number(cost.distance_operations));
    return row;
}

std::string about(const plan::Monitor& monitor) {
    if (monitor.sliding) return fmt::format("{} steps ago", monitor.horizon);
    switch (monitor.restarts) {
        case check::Restarts::never: break;
        case check::Restarts::on_request: return "since restart";
        case check::Restarts::when_final: return "the present cycle";
    }
    return "the prefix";
}

std::string recorder_words(const plan::Recorder& recorder) {
    return fmt::format("{} x ({} + 1 + {}) steps", recorder.incidents, recorder.before,
                       recorder.after);
}

std::vector<Row> monitor_rows(const plan::Plan& plan) {
    const bool both_layouts = laid_out_by_machine(plan);
    std::vector<Row> rows{{"monitor", "about", "state B", "targets B"}};
    if (both_layouts) rows[0].push_back("without SIMD");
    rows[0].insert(rows[0].end(), {"operations", "distance elements"});
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) {
        const plan::Monitor& monitor = plan.monitors[m];
        rows.push_back(
            cost_row({monitor.name, about(monitor)}, plan.monitor_costs[m], both_layouts));
    }
    if (plan::value_type(plan.values).sourced) {
        const plan::Samples samples = plan::samples(plan);
        rows.push_back(cost_row({"samples", "of the last verdicts"},
                                {.state_bytes = plan::bytes_of(samples, plan.monitors.size())},
                                both_layouts));
    }
    if (plan.recorder)
        rows.push_back(cost_row({"recorder", recorder_words(*plan.recorder)},
                                {.state_bytes = plan::recorder_bytes(plan)}, both_layouts));
    rows.push_back(cost_row({"all together", ""}, plan.cost, both_layouts));
    return rows;
}

std::vector<Row> threshold_rows(const plan::Plan& plan) {
    const bool may_change = plan.model->retargetable;
    std::vector<Row> rows{
        {"predicate", "measures", may_change ? "threshold at first" : "threshold", "origin"}};
    for (Index p : plan.predicates) {
        const check::Predicate& predicate = plan.model->predicates[p];
        rows.push_back({predicate.name.empty() ? "-" : predicate.name, predicate.text,
                        check::numbers(predicate.threshold), check::origin(predicate.threshold)});
    }
    return rows;
}

/// Returns a row per projected point.
std::vector<Row> projection_rows(const plan::Plan& plan) {
    const check::Model& model = *plan.model;
    std::vector<Row> rows{{"point", "projection", "rows", "elements"}};
    for (const Index p : plan::projected_points(model, plan.distances)) {
        const check::Projection& map = model.projections[model.points[p].projection];
        rows.push_back({model.points[p].text, fmt::format("{}: {}", map.name, map.origin),
                        number(map.rows), number(map.dimension)});
    }
    return rows;
}

/// Returns a row per distance with the storage of its target set.
std::vector<Row> storage_rows(const plan::Plan& plan) {
    std::vector<Row> rows{{"distance", "measured on", "bytes", "rows moved by", "also kept"}};
    for (Index d : plan.distances) {
        const plan::NarrowSet* set = plan::narrow_set(plan, d);
        const check::Distance& distance = plan.model->distances[d];
        if (distance.is_between_points()) continue;
        const std::uint64_t wide =
            plan.model->targets[distance.target].values.size() * sizeof(float);
        if (set == nullptr)
            rows.push_back({distance.text, "float32", number(wide), "-", "-"});
        else
            rows.push_back({distance.text, set->storage == plan::Storage::f16 ? "float16" : "int8",
                            number(plan::bytes_of(*set)),
                            set->lossless ? "0" : fmt::format("{:.3g}", set->moved),
                            set->lossless ? "-" : fmt::format("float32, {}", wide)});
    }
    return rows;
}

bool is_calibrated(const plan::Plan& plan, bool but_adaptive) {
    if (std::any_of(plan.monitors.begin(), plan.monitors.end(), [&](const plan::Monitor& m) {
            return m.shifted || plan.model->monitors[m.index].duration.has_value();
        }))
        return true;
    return std::any_of(plan.predicates.begin(), plan.predicates.end(), [&](Index p) {
        const check::ThresholdOrigin origin = plan.model->predicates[p].threshold.origin;
        return origin != check::ThresholdOrigin::literal &&
               (!but_adaptive || origin != check::ThresholdOrigin::adaptive);
    });
}

/// Returns whether a threshold or shift counts groups of episodes.
bool counts_groups(const plan::Plan& plan) {
    const auto& monitors = plan.model->monitors;
    return std::any_of(plan.predicates.begin(), plan.predicates.end(),
                       [&](Index p) { return plan.model->predicates[p].threshold.by_group; }) ||
           std::any_of(plan.monitors.begin(), plan.monitors.end(), [&](const plan::Monitor& m) {
               const auto& duration = monitors[m.index].duration;
               return (m.shifted && monitors[m.index].calibration->by_group) ||
                      (duration && duration->threshold.by_group);
           });
}

std::vector<check::Guarantee> guarantees_of(const plan::Plan& plan, const plan::Monitor& monitor) {
    return check::guarantees(*plan.model, plan.model->monitors[monitor.index], plan.values);
}

/// Returns whether some guarantee is about missed successes, and whether some tells the two errors
/// apart.
std::pair<bool, bool> kinds_of_guarantees(const plan::Plan& plan) {
    bool on_successes = false;
    bool on_both = false;
    for (const plan::Monitor& monitor : plan.monitors)
        for (const check::Guarantee& guarantee : guarantees_of(plan, monitor)) {
            on_successes |= guarantee.kind == check::Guarantee::Kind::missed_success;
            on_both |= guarantee.kind >= check::Guarantee::Kind::satisfied_wrongly;
        }
    return {on_successes, on_both};
}

bool sets_zero_aside(const plan::Plan& plan) {
    return std::any_of(
        plan.monitors.begin(), plan.monitors.end(), [&](const plan::Monitor& monitor) {
            const std::vector<check::Guarantee> guarantees = guarantees_of(plan, monitor);
            return std::any_of(
                guarantees.begin(), guarantees.end(),
                [](const check::Guarantee& guarantee) { return guarantee.zero_aside; });
        });
}

/// Returns the guarantees: a row per monitor, or a row per conjunct if the whole has none.
std::vector<Row> guarantee_rows(const plan::Plan& plan) {
    std::vector<Row> rows{{"monitor", "guarantee"}};
    for (const plan::Monitor& monitor : plan.monitors) {
        const auto& calibration = plan.model->monitors[monitor.index].calibration;
        std::vector<check::Guarantee> guarantees = guarantees_of(plan, monitor);
        for (check::Guarantee& guarantee : guarantees) {
            guarantee.part = shortened(guarantee.part);
            const bool has_shift = monitor.shifted && guarantees.size() == 1;
            rows.push_back(
                {&guarantee == &guarantees.front() ? monitor.name : "",
                 check::text(guarantee) + (has_shift ? "; " + check::of_shift(*calibration) : "")});
        }
        if (monitor.shifted && guarantees.size() > 1)
            rows.push_back({"", check::of_shift(*calibration)});
        if (const auto& duration = plan.model->monitors[monitor.index].duration)
            rows.push_back({"", check::of_duration(*plan.model, *duration)});
    }
    return rows;
}

/// Prints the guarantee of adaptive thresholds: a rate of misses that holds for any sequence of
/// frames.
void print_miss_rates(Printer& out, const std::string& prefix, const plan::Plan& plan) {
    std::vector<Row> rows{
        {"adaptive", "of the first T labelled positive frames it misses at most"}};
    for (Index p : plan.predicates) {
        const check::Predicate& predicate = plan.model->predicates[p];
        if (predicate.threshold.adaptation)
            rows.push_back({predicate.name, check::miss_bound(predicate)});
    }
    if (rows.size() == 1) return;
    out.line(blank(prefix));
    print_table(out, prefix, rows, 2);
    out.line(blank(prefix));
    print_sentences(
        out, prefix,
        "A miss is beyond the threshold in force when its label arrives. H is the "
        "number of misses that arrive while the threshold is held at the end of its range. "
        "Before the first label the threshold is the conformal one.");
}

void print_guarantees(Printer& out, const std::string& prefix, const plan::Plan& plan) {
    out.line(blank(prefix));
    print_table(out, prefix, guarantee_rows(plan), 2);
    print_miss_rates(out, prefix, plan);
    const std::vector<std::string>& reservations = plan.model->reservations;
    const bool of_episodes = is_calibrated(plan, true);
    const bool by_group = counts_groups(plan);
    const bool zero_aside = sets_zero_aside(plan);
    if (of_episodes || zero_aside || !reservations.empty()) out.line(blank(prefix));
    if (zero_aside) print_sentences(out, prefix, check::kZeroAside);
    for (const std::string& reservation : reservations) print_sentences(out, prefix, reservation);
    if (of_episodes) {
        std::string text = fmt::format(
            "{} coverage: 5 % and 95 % quantile of Beta(k, n + 1 - k), of {} given these "
            "demonstrations, more where scores tie.",
            check::exchangeability(by_group),
            by_group ? "an episode of a new group" : "a new episode");
        const auto [on_successes, on_both] = kinds_of_guarantees(plan);
        if (on_successes) text += fmt::format(" {}", check::kMissingAside);
        if (on_both)
            text +=
                " A verdict is satisfied or violated wrongly if its truth is the opposite; one "
                "that is unknown is neither.";
        print_sentences(out, prefix, text);
    }
}

/// Prints the hashes that the class has as constants.
void print_made_from(Printer& out, const std::string& prefix, const Context& context) {
    const check::Fingerprint made_from = check::fingerprint(context.model);
    const auto hash = [](std::uint64_t value) {
        return value == 0 ? std::string("none") : fmt::format("{:016x}", value);
    };
    std::vector<Row> rows = {{"made from", "XXH64"},
                             {context.spec_file, hash(made_from.spec)},
                             {"target sets and weights", hash(made_from.data)},
                             {"thresholds", hash(made_from.thresholds)}};
    for (const check::Encoder& encoder : context.model.encoders)
        rows.push_back({"encoder " + encoder.name, encoder.fingerprint});
    print_table(out, prefix, rows, 2);
    out.line(blank(prefix));
}

void print_tables(Printer& out, const std::string& prefix, const plan::Plan& plan) {
    print_table(out, prefix, monitor_rows(plan), 2);
    if (laid_out_by_machine(plan))
        out.line(prefix + "targets B on x86-64 and 64-bit Arm; without SIMD: on microcontrollers");
    out.line(blank(prefix));
    if (!plan.predicates.empty()) print_table(out, prefix, threshold_rows(plan), 4);
    if (const std::vector<Row> rows = projection_rows(plan); rows.size() > 1) {
        out.line(blank(prefix));
        print_table(out, prefix, rows, 2);
    }
    if (!plan.narrow.empty()) {
        out.line(blank(prefix));
        print_table(out, prefix, storage_rows(plan), 2);
    }
    if (is_calibrated(plan, false)) print_guarantees(out, prefix, plan);
    if (!plan.model->retargetable) return;
    out.line(blank(prefix));
    print_sentences(out, prefix, about_parameters(plan, is_calibrated(plan, false)));
}

/// Prints the target sets stored outside the header, and their sizes.
void print_stored(Printer& out, const std::string& prefix, const plan::Plan& plan,
                  const std::string& file) {
    if (plan.stored.empty()) return;
    std::vector<Row> rows{{"in " + file, "rows", "elements", "bytes"}};
    for (const plan::StoredSet& set : plan.stored) {
        const plan::StoredNumbers numbers = plan::numbers_of(*plan.model, set);
        rows.push_back({numbers.origin + (set.as_given ? "" : ", scaled to length 1"),
                        number(numbers.rows), number(numbers.dimension),
                        number(numbers.rows * set.row_bytes)});
    }
    rows.push_back({"all together", "", "", number(plan::stored_bytes(plan))});
    out.line(blank(prefix));
    print_table(out, prefix, rows, 1);
}

/// Prints the values of the spec's constants.
void print_settings(Printer& out, const std::string& prefix, const check::Model& model) {
    if (model.constants.empty()) return;
    std::string list;
    for (const check::Constant& constant : model.constants)
        list += fmt::format("{}{} = {}{}", list.empty() ? "" : ", ", constant.name, constant.text,
                            constant.is_set ? " (by --set)" : "");
    out.line(blank(prefix));
    print_sentences(out, prefix, fmt::format("Constants: {}.", list));
}

/// Prints the rounding of durations that are not whole numbers of steps.
void print_rounded(Printer& out, const std::string& prefix, const check::Model& model) {
    if (model.rounded.empty()) return;
    std::string list;
    for (const auto& [duration, steps] : model.rounded)
        list += fmt::format("{}{} is {} step{}", list.empty() ? "" : ", ", duration, steps,
                            steps == 1 ? "" : "s");
    out.line(blank(prefix));
    print_sentences(out, prefix,
                    fmt::format("Durations are rounded {}: {}.", model.rounding, list));
}

}  // namespace

void print_figures(Printer& out, const std::string& prefix, const plan::Plan& plan,
                   const std::string& targets_file) {
    print_tables(out, prefix, plan);
    print_stored(out, prefix, plan, targets_file);
    print_settings(out, prefix, *plan.model);
    print_rounded(out, prefix, *plan.model);
}

void print_summary(Printer& out, const Context& context) {
    out.line("//");
    print_made_from(out, "//   ", context);
    print_figures(out, "//   ", context.plan, context.targets_file);
    out.line("//");
    print_sentences(
        out, "//",
        fmt::format("state B: bytes of state of a monitor by itself; what several share is counted "
                    "for each. operations: min, max and comparisons of robustness keys in the "
                    "worst-case step. distance elements: target elements that a step compares with "
                    "its input{}.",
                    context.names.stale_member.empty() ? "" : ", and elements of its last sample"));
    if (context.stores_targets())
        out.line("// Besides state B, a monitor holds a pointer to its targets.");
}

}  // namespace etlc::emit
