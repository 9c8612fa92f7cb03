#include "plan/decide/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "plan/program/budget.hpp"

namespace etlc::plan {

namespace {

constexpr std::size_t kMostNamed = 3;

std::string figures(const Cost& cost) {
    const std::string stack = cost.stack_bytes == 0
                                  ? ""
                                  : fmt::format(" and {} on the stack of a step", cost.stack_bytes);
    return fmt::format("{} bytes of state{}, {} bytes of code (estimated), {} operations a step",
                       cost.state_bytes, stack, cost.code_bytes, cost.operations);
}

std::string limit_figures(const Limits& limits) {
    return fmt::format("the limits are {}, {} and {}", limits.state_bytes, limits.code_bytes,
                       limits.operations);
}

// ---- operators that a state machine must count

void collect_future(const ir::Graph& graph, ir::NodeId id, std::set<ir::NodeId>& seen) {
    if (!graph[id].has_future || !seen.insert(id).second) return;
    for (ir::NodeId operand : graph[id].operands) collect_future(graph, operand, seen);
}

/// The steps of its window that a state machine counts one by one.
std::uint32_t counted(const ir::Node& node) {
    return node.interval.bounded() ? node.interval.high : node.interval.low;
}

/// Those that look ahead, longest windows first; where none has a window, the outer ones.
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

struct Part {
    ir::NodeId node = kNone;
    Cost cost;
};

/// By what they need of what is short, in parts of the limit.
std::vector<Part> costly_parts(const Plan& plan, const Limits& limits) {
    const auto share = [](std::uint64_t need, std::uint64_t all, std::uint64_t limit) {
        return all <= limit ? 0.0 : static_cast<double>(need) / static_cast<double>(limit + 1);
    };
    const Cost& all = plan.cost;
    const auto weight = [&](const Cost& cost) {
        return share(cost.state_bytes + cost.stack_bytes, all.state_bytes + all.stack_bytes,
                     limits.state_bytes) +
               share(cost.code_bytes, all.code_bytes, limits.code_bytes) +
               share(cost.operations, all.operations, limits.operations);
    };
    std::vector<Part> parts;
    for (const Reading& reading : plan.readings)
        parts.push_back({reading.node, cost_of(reading, plan.values)});
    for (const Stream& stream : plan.streams)
        if (stream.node != kNone) parts.push_back({stream.node, cost_of(stream, plan.values)});
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
                 diag::Sink& sink) {
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
                    figures(cost_of_table(part.reached.states, part.reached.transitions, values)),
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
    error.note(
        "shorter windows or fewer nested operators make it smaller; --max-state and --max-code "
        "move the limits");
}

void check_budget(const Plan& plan, const Limits& limits, diag::Sink& sink) {
    if (within(plan.cost, limits)) return;
    const ir::Graph& graph = *plan.formulas;
    const check::Model& model = *plan.model;
    auto& error = sink.report(
        diag::Code::over_budget, model.monitors.front().span,
        fmt::format("the monitor class needs {}; {}", figures(plan.cost), limit_figures(limits)));
    for (std::size_t m = 0; m < plan.monitors.size(); ++m)
        error.note(model.monitors[plan.monitors[m].index].span,
                   fmt::format("'{}' alone needs {}", plan.monitors[m].name,
                               figures(plan.monitor_costs[m])));
    for (const Part& part : costly_parts(plan, limits))
        error.note(graph[part.node].span, fmt::format("of that, '{}' takes {}",
                                                      graph.text(part.node), figures(part.cost)));
    error.note("--max-state, --max-code and --max-work move the limits");
}

}  // namespace etlc::plan
