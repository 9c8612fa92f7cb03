// Evaluates formulas at every position of a prefix, in values that carry the sample they come from,
// and derives the verdict. The work is proportional to nodes times steps, whatever the windows.
// Equal formulas have equal values, sample included, however they are written: values are totally
// ordered, and a min or a max is one of its operands.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "etlmon/temporal/monoid.hpp"
#include "explain/explain.hpp"
#include "explain/observations.hpp"
#include "ir/graph.hpp"

namespace etlc::explain {

using ir::NodeId;

/// A robustness with its sample. Of equal ones, that of the earlier sample counts as farther from
/// 0; true and false themselves are farthest.
struct Sourced {
    etlmon::Key key = 0;
    std::int64_t rank = 0;

    auto operator<=>(const Sourced&) const = default;
    Sourced operator-() const { return {-key, -rank}; }
};
inline constexpr Sourced kTrueItself{etlmon::kTop, INT64_MAX};
inline constexpr Sourced kFalseItself{etlmon::kBottom, -INT64_MAX};

/// The pessimistic and the optimistic end where samples are missing.
struct Bounds {
    Sourced lower;
    Sourced upper;

    bool operator==(const Bounds&) const = default;
};
constexpr Bounds min_of(Bounds a, Bounds b) {
    return {std::min(a.lower, b.lower), std::min(a.upper, b.upper)};
}
constexpr Bounds max_of(Bounds a, Bounds b) {
    return {std::max(a.lower, b.lower), std::max(a.upper, b.upper)};
}

/// Values of the prefix as it ends, or bounds over every continuation of it (docs/semantics.md).
enum class Semantics : std::uint8_t { so_far, for_good };

/// Changed measurements of one step.
struct Altered {
    std::uint64_t step = 0;
    std::vector<Index> atoms;
    float measured = 0;

    bool is_of(Index atom) const {
        return std::find(atoms.begin(), atoms.end(), atom) != atoms.end();
    }
};

class Values {
public:
    /// Evaluates `nodes`, which include their operands, on the prefix 0..last.
    Values(const ir::Graph& graph, const std::vector<bool>& nodes, const Observations& observations,
           std::uint64_t last, Semantics semantics, const Altered* altered = nullptr);

    bool has(NodeId node) const { return node < values_.size() && !values_[node].empty(); }
    Bounds at(NodeId node, std::uint64_t position) const { return values_[node][position]; }
    /// Returns the sample of a value; nothing for that of an empty window, a constant, or an unseen
    /// step.
    std::optional<Sample> source(Sourced value) const;

    /// Returns the value of the node with other measurements; evaluates only what these change.
    Bounds at_with(const Altered& altered, NodeId node, std::uint64_t position);

private:
    using Column = std::vector<Bounds>;
    /// A value before a change that is undone.
    struct Before {
        NodeId node = 0;
        std::size_t position = 0;
        Bounds value;
    };

    Bounds constant_or_literal(const ir::Node& node, std::size_t step,
                               const Altered* altered) const;
    Bounds combined(const ir::Node& node, std::size_t position) const;
    Column temporal(const ir::Node& node) const;
    Column counted(const ir::Node& node) const;
    Bounds unseen(const ir::Node& node) const;

    void set(NodeId node, std::size_t position, Bounds value);
    void alter(NodeId node, const Altered& altered);

    const ir::Graph* graph_;
    const Observations* observations_;
    std::size_t atoms_;
    std::size_t seen_;  ///< positions of the prefix
    Semantics semantics_;
    /// [node][position]; empty: not evaluated. With bounds, the position after the prefix stands
    /// for the unseen future and has the lowest and the highest unseen value.
    std::vector<Column> values_;
    std::vector<std::vector<std::size_t>> changed_;  ///< [node]: the positions, while altered
    std::vector<Before> before_;
};

/// Returns these nodes and all below them.
std::vector<bool> closure(const ir::Graph& graph, const std::vector<NodeId>& roots);

/// A monitor's formula at a position of a prefix.
struct Subject {
    const ir::Graph& graph;
    const Observations& observations;
    NodeId root = 0;
    std::vector<bool> nodes;  ///< below the root and of all formulas in the monitor's
    std::uint64_t position = 0;
    std::uint64_t last = 0;  ///< of the prefix
    /// Subtracted from the verdict: from its low end, and from its high one.
    float low_shift = 0;
    float high_shift = 0;

    /// Returns whether a key supports the status: satisfied as a low end, violated as a high one.
    bool supports(Status status, etlmon::Key key) const;
    /// Returns an end less its shift.
    static etlmon::Key end_of(etlmon::Key key, float shift);
};

struct Judged {
    Status status = Status::unknown;
    Semantics semantics = Semantics::so_far;  ///< whether the verdict is final
    Values values;

    /// Returns the deciding end: the pessimistic one where satisfied, else the optimistic one.
    Sourced deciding(Bounds value) const {
        return status == Status::satisfied ? value.lower : value.upper;
    }
    Sourced at(NodeId node, std::uint64_t position) const {
        return deciding(values.at(node, position));
    }
};
Judged judge(const Subject& subject, const Altered* altered = nullptr);

}  // namespace etlc::explain

template <>
struct etlmon::Lattice<etlc::explain::Bounds> {
    static constexpr etlc::explain::Bounds bottom() {
        return {etlc::explain::kFalseItself, etlc::explain::kFalseItself};
    }
    static constexpr etlc::explain::Bounds top() {
        return {etlc::explain::kTrueItself, etlc::explain::kTrueItself};
    }
};
