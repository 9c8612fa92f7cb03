// Builds readings, the part of the plan that evaluates prefix formulas at position 0. Each
// sub-formula gets the smallest exact one: a latch, a fold, or an automaton. Equal readings are
// built once; a formula too large for the limits is reported, never approximated.
#pragma once

#include <map>
#include <vector>

#include "plan/budget/budget.hpp"
#include "plan/decide/automaton.hpp"
#include "plan/program/program.hpp"

namespace etlc::plan {

class ReadingBuilder {
public:
    /// `graph`: the plan's copy of the program's, to which readings add formulas.
    ReadingBuilder(const ir::Program& program, ir::Graph& graph, StreamBuilder& streams,
                   std::vector<Reading>& readings, const Limits& limits, check::Values values);

    /// A sub-formula whose automaton would exceed the limits.
    struct Oversize {
        NodeId node = 0;
        AutomatonSize reached;
    };

    /// Returns the reading of a formula; nothing where a part is too large, which `oversize` then
    /// names.
    std::optional<std::uint32_t> of(NodeId node);
    const std::vector<Oversize>& oversize() const { return oversize_; }

private:
    std::optional<std::uint32_t> combination(const ir::Node& node, NodeId id);
    /// Builds a state machine over formulas without future, within these limits and the remaining
    /// work.
    std::optional<Machine> machine(NodeId id, const AutomatonLimits& limits);
    Reading as_reading(NodeId id, const Machine& machine) const;
    std::optional<Reading> over_windows(NodeId id);
    std::optional<Reading> pending(const ir::Node& node, NodeId id);
    std::uint32_t pending_part(Pending& pending, std::map<NodeId, std::uint32_t>& known, NodeId id);
    std::optional<std::uint32_t> apart(NodeId id, double below);
    std::optional<Reading> as_chain(NodeId id);
    std::optional<std::uint32_t> nested(const ir::Node& node, NodeId id);
    std::uint32_t add(Reading reading);
    std::uint32_t add(NodeId id, std::string as, Straight code);
    Machine::State state(const std::vector<NodeId>& obligations);
    Machine machine_of(Automaton automaton);
    std::optional<Automaton> automaton(NodeId id, Literals literals, AutomatonLimits limits,
                                       AutomatonSize& reached);

    const ir::Program& program_;
    ir::Graph& graph_;
    StreamBuilder& streams_;
    std::vector<Reading>& readings_;
    Limits limits_;
    check::Values values_;
    std::uint64_t work_left_;
    bool is_apart_ = false;
    /// By formula and by the monitor that it starts with.
    std::map<std::pair<NodeId, std::uint32_t>, std::uint32_t> known_;
    std::vector<Oversize> oversize_;
};

}  // namespace etlc::plan
