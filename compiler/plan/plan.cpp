#include "plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "plan/budget/budget.hpp"
#include "plan/decide/readings.hpp"
#include "plan/decide/refusal.hpp"
#include "plan/decide/streams.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::plan {

namespace {

/// Sets the inputs, distances, past numbers and targets that these predicates and inputs need.
void need(Plan& plan, std::set<Index> inputs, const std::set<Index>& predicates) {
    const check::Model& model = *plan.model;
    std::set<Index> distances;
    std::set<Index> pasts;
    for (Index p : predicates) {
        inputs.insert(model.predicates[p].inputs.begin(), model.predicates[p].inputs.end());
        check::for_each(model.predicates[p].expression, [&](const check::Expr& e) {
            if (e.kind == check::Expr::Kind::distance) distances.insert(e.index);
            if (e.kind == check::Expr::Kind::past) pasts.insert(e.index);
        });
    }
    std::set<Index> targets;
    for (Index d : distances)
        if (!model.distances[d].is_between_points()) targets.insert(model.distances[d].target);
    plan.inputs.assign(inputs.begin(), inputs.end());
    plan.predicates.assign(predicates.begin(), predicates.end());
    plan.distances.assign(distances.begin(), distances.end());
    plan.pasts.assign(pasts.begin(), pasts.end());
    plan.targets.assign(targets.begin(), targets.end());
}

/// Checks that the places of parameters fit into 32 bits.
void check_parameters(const Plan& plan, diag::Sink& sink) {
    constexpr std::uint64_t kMostFloats = std::uint64_t{1} << 29U;
    std::uint64_t floats = 0;
    for (const Index t : plan.targets) {
        const check::Target& target = plan.model->targets[t];
        floats += 2 * target.values.size();  // possibly normalised as well
        if (floats <= kMostFloats) continue;
        sink.report(diag::Code::not_retargetable, target.span,
                    fmt::format("'{}' and what stands before it take more than the 2 GiB that "
                                "parameters of --retargetable may have",
                                target.name));
        return;
    }
}

/// Identifies windows that take the same element at each step and start together. While finish()
/// reports the last positions they still do, except for one without lag, which has no position
/// there.
using Signal = std::tuple<bool, std::vector<Slot>, std::uint32_t, bool, std::uint32_t>;

void widen(Stream& stream, Slot from, std::uint32_t from_length) {
    stream.op = StreamOp::widening;
    stream.operands = {from};
    stream.from_length = from_length;
}

/// Turns a window into the widening of a shorter one over the same signal that is at least half as
/// long (etlmon::Widening). Values stay the same; operands may come after their users until the
/// plan is sorted.
void share_windows(Plan& plan) {
    // Over truth values a window is a counter, which is cheapest.
    if (value_type(plan.values).on_demand) return;
    std::map<Signal, std::vector<Slot>> watching;
    for (Slot slot = 0; slot < plan.streams.size(); ++slot) {
        const Stream& stream = plan.streams[slot];
        if (stream.op == StreamOp::window && stream.length > 1)
            watching[{stream.max, stream.operands, stream.operand_lag, stream.lag == 0,
                      stream.begins_with}]
                .push_back(slot);
    }
    for (auto& [signal, windows] : watching) {
        const auto length = [&](Slot slot) { return plan.streams[slot].length; };
        std::stable_sort(windows.begin(), windows.end(),
                         [&](Slot a, Slot b) { return length(a) < length(b); });
        for (std::size_t i = windows.size(); i-- > 1;) {
            const Slot from = windows[i - 1];
            const bool longer = length(from) < length(windows[i]);
            if (longer && length(windows[i]) - length(from) <= length(from))
                widen(plan.streams[windows[i]], from, length(from));
        }
    }
}

class Planning {
public:
    Planning(const ir::Program& program, const Limits& limits, check::Values values)
        : program_(program),
          limits_(limits),
          formulas_(std::make_shared<ir::Graph>(program.graph)),
          streams_(*formulas_, plan_.streams, values),
          readings_(program, *formulas_, streams_, plan_.readings, limits, values) {
        plan_.model = &program.graph.model();
        plan_.formulas = formulas_;
        plan_.values = values;
    }

    /// Returns false after reporting the part of a monitor that is too large.
    bool add_monitor(Index index, diag::Sink& sink, const Advice& advice) {
        const check::Monitor& source = plan_.model->monitors[index];
        Monitor monitor{.name = source.name,
                        .sliding = source.sliding,
                        .restarts = source.restarts,
                        .horizon = source.horizon,
                        .ahead = source.sliding ? kUnbounded : source.ahead,
                        .index = index,
                        .node = program_.monitors[index]};
        if (source.calibration) {
            if (plan_.values == check::Values::boolean) {
                sink.report(
                    diag::Code::calibration_not_available, source.calibration->span,
                    fmt::format(
                        "'{}' is calibrated as a whole, which shifts its robustness; with --values "
                        "boolean it has none",
                        source.name));
                return false;
            }
            monitor.shifted = true;
            monitor.shift = source.calibration->value;
            monitor.inner_shift = source.calibration->inner;
        }
        if (source.sliding) {
            plan_.has_sliding = true;
            streams_.begin_with(kNone);
            const Slot slot = streams_.of(program_.monitors[index]);
            monitor.stream = streams_.delayed(slot, source.horizon - plan_.streams[slot].lag);
        } else {
            const auto own = static_cast<std::uint32_t>(plan_.monitors.size());
            streams_.begin_with(source.restarts == check::Restarts::never ? kNone : own);
            const std::size_t known = readings_.oversize().size();
            const auto reading = readings_.of(program_.monitors[index]);
            for (std::size_t i = known; i < readings_.oversize().size(); ++i)
                refuse_part(source, readings_.oversize()[i], *formulas_, limits_, plan_.values,
                            advice ? advice(index, Among::alone) : std::vector<diag::Note>{}, sink);
            if (!reading) return false;
            monitor.reading = *reading;
        }
        plan_.monitors.push_back(std::move(monitor));
        return true;
    }

    void add_lets() {
        streams_.begin_with(kNone);
        for (Index i = 0; i < program_.lets.size(); ++i)
            if (program_.lets[i] != kNone) plan_.lets.push_back({i, streams_.of(program_.lets[i])});
    }

    void add_drifts() {
        for (Index d = 0; d < plan_.model->drifts.size(); ++d)
            if (plan_.model->drifts[d].is_calibrated()) plan_.drifts.push_back(d);
    }

    Plan finish(Storage targets_as, diag::Sink& sink) {
        keep_used_streams();
        share_windows(plan_);
        keep_used_streams();
        collect_inputs();
        if (!plan_.model->retargetable)
            plan_.stored = stored_sets(plan_, limits_.inline_target_bytes);
        narrow_targets(plan_, targets_as, sink);
        check_drifts(sink);
        count_steps();
        add_costs(plan_);
        return std::move(plan_);
    }

private:
    /// A score is compared with those of calibration, so it needs exact distances at every step.
    void check_drifts(diag::Sink& sink) const {
        const bool is_boolean = plan_.values == check::Values::boolean;
        const auto is_bounded = [](const NarrowSet& set) { return !set.lossless; };
        if (!is_boolean && std::none_of(plan_.narrow.begin(), plan_.narrow.end(), is_bounded))
            return;
        for (const Index d : plan_.drifts)
            sink.report(
                diag::Code::drift_of, plan_.model->drifts[d].span,
                fmt::format("'{}' needs the exact distance at every step; {}",
                            plan_.model->drifts[d].name,
                            is_boolean ? "with --values boolean it is measured only where a "
                                         "verdict depends on it"
                                       : "with --targets-as it is known within bounds only"));
    }

    /// Drops streams that folding left unused, and puts operands before their users after sharing.
    void keep_used_streams() {
        std::vector<bool> used(plan_.streams.size(), false);
        const auto use = [&](const auto& self, Slot slot) -> void {
            if (used[slot]) return;
            used[slot] = true;
            for (Slot operand : plan_.streams[slot].operands) self(self, operand);
        };
        for_each_root([&](Slot& slot) { use(use, slot); });

        std::vector<Slot> renumbered(plan_.streams.size(), kNone);
        std::vector<Stream> kept;
        const auto keep = [&](const auto& self, Slot slot) -> Slot {
            if (renumbered[slot] != kNone) return renumbered[slot];
            for (Slot& operand : plan_.streams[slot].operands) operand = self(self, operand);
            kept.push_back(std::move(plan_.streams[slot]));
            return renumbered[slot] = static_cast<Slot>(kept.size() - 1);
        };
        for (Slot slot = 0; slot < plan_.streams.size(); ++slot)
            if (used[slot]) keep(keep, slot);
        plan_.streams = std::move(kept);
        for_each_root([&](Slot& slot) { slot = renumbered[slot]; });
    }

    /// Marks what counts steps, from the start of the trace or of a monitor.
    void count_steps() {
        plan_.counts_steps = plan_.has_sliding;
        const auto count = [&](std::uint32_t from) {
            (from == kNone ? plan_.counts_steps : plan_.monitors[from].counts_steps) = true;
        };
        for (const Reading& reading : plan_.readings)
            if (asks_position(reading)) count(reading.begins_with);
        for (const Stream& stream : plan_.streams)
            if (stream.op == StreamOp::within) count(stream.begins_with);
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m)
            if (plan_.monitors[m].ahead > 0 && plan_.monitors[m].ahead != kUnbounded)
                count(plan_.monitors[m].begins_with(m));
    }

    /// Visits every reference to a stream outside the streams.
    template <class Visit>
    void for_each_root(Visit visit) {
        for (Reading& reading : plan_.readings) plan::for_each_slot(reading, visit);
        for (Monitor& monitor : plan_.monitors)
            if (monitor.sliding) visit(monitor.stream);
        for (Let& let : plan_.lets) visit(let.stream);
    }

    void collect_inputs() {
        std::set<Index> flags;
        std::set<Index> predicates;
        for (const Stream& stream : plan_.streams) {
            if (stream.op == StreamOp::flag) flags.insert(stream.index);
            if (stream.op == StreamOp::predicate) predicates.insert(stream.index);
        }
        for (const Index d : plan_.drifts)
            if (plan_.model->drifts[d].predicate != kNone)
                predicates.insert(plan_.model->drifts[d].predicate);
        need(plan_, std::move(flags), predicates);
    }

    const ir::Program& program_;
    const Limits& limits_;
    std::shared_ptr<ir::Graph> formulas_;
    Plan plan_;
    StreamBuilder streams_;
    ReadingBuilder readings_;
};

}  // namespace

std::optional<Plan> plan(const ir::Program& program, const Limits& limits, diag::Sink& sink,
                         check::Values values, Storage targets_as, const Advice& advice) {
    Planning planning(program, limits, values);
    bool complete = true;
    for (Index m = 0; m < program.monitors.size(); ++m)
        complete = planning.add_monitor(m, sink, complete ? advice : Advice{}) && complete;
    if (!complete) return std::nullopt;
    planning.add_lets();
    planning.add_drifts();
    Plan result = planning.finish(targets_as, sink);
    if (result.model->retargetable) check_parameters(result, sink);
    check_budget(result, limits, advice, sink);
    if (sink.has_errors()) return std::nullopt;
    return result;
}

Plan measuring(const check::Model& model, const std::vector<Index>& predicates) {
    Plan plan;
    plan.model = &model;
    need(plan, {}, {predicates.begin(), predicates.end()});
    return plan;
}

}  // namespace etlc::plan
