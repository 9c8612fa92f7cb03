#include "plan/decide/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "plan/budget/budget.hpp"

namespace etlc::plan {

namespace {

constexpr std::size_t kMostNamed = 3;

std::string limit_figures(const Limits& limits) {
    return fmt::format("the limits are {}, {} and {}", limits.state_bytes, limits.code_bytes,
                       limits.operations);
}

// ---- operators that a state machine must count

void collect_future(const ir::Graph& graph, ir::NodeId id, std::set<ir::NodeId>& seen) {
    if (!graph[id].has_future || !seen.insert(id).second) return;
    for (ir::NodeId operand : graph[id].operands) collect_future(graph, operand, seen);
}

/// Returns the steps of a window that a state machine counts one by one.
std::uint32_t counted(const ir::Node& node) {
    return node.interval.bounded() ? node.interval.high : node.interval.low;
}

/// Returns the operators that look ahead, longest windows first; the outer ones where none has a
/// window.
std::vector<ir::NodeId> costly_operators(const ir::Graph& graph, ir::NodeId part) {
    std::set<ir::NodeId> found;
    collect_future(graph, part, found);
    std::vector<ir::NodeId> result(found.begin(), found.end());
    std::erase_if(result,
                  [&](ir::NodeId id) { return ir::info(graph[id].op).tense != ir::Tense::future; });
    std::stable_sort(result.begin(), result.end(), [&](ir::NodeId a, ir::NodeId b) {
        return counted(graph[a]) > counted(graph[b]);
    });
    if (counted(graph[result.front()]) > 0)
        std::erase_if(result, [&](ir::NodeId id) { return counted(graph[id]) == 0; });
    result.resize(std::min(result.size(), kMostNamed));
    return result;
}

// ---- parts of a plan

/// A formula, or a number that earlier steps have a part in.
struct Part {
    source::Span span;
    std::string text;
    Cost cost;
};

/// Weighs a cost by the limits that the plan exceeds.
double weight_of(const Cost& cost, const Cost& all, const Limits& limits) {
    const auto share = [](std::uint64_t need, std::uint64_t of_all, std::uint64_t limit) {
        return of_all <= limit ? 0.0 : static_cast<double>(need) / static_cast<double>(limit + 1);
    };
    return share(cost.state_bytes + cost.stack_bytes, all.state_bytes + all.stack_bytes,
                 limits.state_bytes) +
           share(cost.code_bytes, all.code_bytes, limits.code_bytes) +
           share(cost.operations, all.operations, limits.operations);
}

Index costliest_monitor(const Plan& plan, const Limits& limits) {
    const auto costliest = std::max_element(
        plan.monitor_costs.begin(), plan.monitor_costs.end(), [&](const Cost& a, const Cost& b) {
            return weight_of(a, plan.cost, limits) < weight_of(b, plan.cost, limits);
        });
    return plan.monitors[static_cast<std::size_t>(costliest - plan.monitor_costs.begin())].index;
}

std::vector<Part> costly_parts(const Plan& plan, const Limits& limits) {
    const auto weight = [&](const Cost& cost) { return weight_of(cost, plan.cost, limits); };
    const ir::Graph& graph = *plan.formulas;
    std::vector<Part> parts;
    const auto add = [&](ir::NodeId node, const Cost& cost) {
        if (node != kNone) parts.push_back({graph[node].span, graph.text(node), cost});
    };
    for (const Reading& reading : plan.readings) add(reading.node, cost_of(reading, plan.values));
    for (const Stream& stream : plan.streams) add(stream.node, cost_of(stream, plan.values));
    for (const Index p : plan.pasts) {
        const check::Past& past = plan.model->pasts[p];
        parts.push_back({past.span, past.text, cost_of(past)});
    }
    const check::Model& model = *plan.model;
    for (const EarlierPoint& earlier : earlier_points(model, plan.distances)) {
        const check::Point& point = model.points[earlier.point];
        parts.push_back({model.inputs[point.inputs[0]].span,
                         fmt::format("{}@{}", point.text, earlier.steps), cost_of(model, earlier)});
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [&](const Part& a, const Part& b) { return weight(a.cost) > weight(b.cost); });
    parts.resize(std::min(parts.size(), kMostNamed));
    std::erase_if(parts, [&](const Part& part) {
        return weight(part.cost) < 0.1 * weight(parts.front().cost);
    });
    return parts;
}

}  // namespace

void refuse_part(const check::Monitor& monitor, const ReadingBuilder::Oversize& part,
                 const ir::Graph& graph, const Limits& limits, check::Values values,
                 std::vector<diag::Note> alternatives, diag::Sink& sink) {
    const std::string_view why = part.reached.out_of_work
                                     ? "that takes more work to build than the limits allow"
                                     : "larger than the limits";
    auto& error = sink.report(
        diag::Code::formula_too_large, graph[part.node].span,
        fmt::format("monitor '{}' needs a state machine {} for '{}': building it "
                    "stopped at {} states and {} "
                    "transitions, which take {} so far; {}",
                    monitor.name, why, graph.text(part.node), part.reached.states,
                    part.reached.transitions,
                    in_words(cost_of_table(part.reached.states, part.reached.transitions, values)),
                    limit_figures(limits)));
    for (ir::NodeId id : costly_operators(graph, part.node)) {
        const ir::Node& node = graph[id];
        const std::string text = graph.text(id);
        if (counted(node) > 0)
            error.note(node.span, fmt::format("the {} steps of '{}' are counted one by one",
                                              counted(node), text));
        else
            error.note(node.span,
                       fmt::format("'{}' is followed from each position separately", text));
    }
    for (diag::Note& note : alternatives) error.notes.push_back(std::move(note));
    error.note(
        "shorter windows or fewer nested operators make it smaller; --max-state and --max-code "
        "move the limits");
}

void check_budget(const Plan& plan, const Limits& limits, const Advice& advice, diag::Sink& sink) {
    if (within(plan.cost, limits)) return;
    const check::Model& model = *plan.model;
    auto& error = sink.report(
        diag::Code::over_budget, model.monitors.front().span,
        fmt::format("the monitor class needs {}; {}", in_words(plan.cost), limit_figures(limits)));
    for (std::size_t m = 0; m < plan.monitors.size(); ++m)
        error.note(model.monitors[plan.monitors[m].index].span,
                   fmt::format("'{}' alone needs {}", plan.monitors[m].name,
                               in_words(plan.monitor_costs[m])));
    for (const Part& part : costly_parts(plan, limits))
        error.note(part.span,
                   fmt::format("of that, '{}' takes {}", part.text, in_words(part.cost)));
    if (advice)
        for (diag::Note& note : advice(costliest_monitor(plan, limits), Among::all))
            error.notes.push_back(std::move(note));
    error.note("--max-state, --max-code and --max-work move the limits");
}

}  // namespace etlc::plan
