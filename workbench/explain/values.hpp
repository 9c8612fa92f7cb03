// What formulas come to at every position of a prefix, with the sample that each value is that of.
// Takes: the graph, which nodes, the observations, and which end of what missing samples leave
// open. Gives: a value per node and position. Keeps true: the work is proportional to nodes times
// steps, whatever the windows; equal formulas have equal values, sample included, however they are
// written, since values are totally ordered and a min or a max is one of its operands.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "explain/observations.hpp"
#include "ir/graph.hpp"

namespace etlc::explain {

using ir::NodeId;

/// A robustness and the sample that it is that of. Of equal ones, the earlier sample counts as
/// farther from 0; true and false themselves are farthest.
struct Sourced {
    etlmon::Key key = 0;
    std::int64_t rank = 0;

    auto operator<=>(const Sourced&) const = default;
    Sourced operator-() const { return {-key, -rank}; }
};
inline constexpr Sourced kTrueItself{etlmon::kTop, INT64_MAX};
inline constexpr Sourced kFalseItself{etlmon::kBottom, -INT64_MAX};

/// Pessimistic or optimistic about what is missing.
enum class End : std::uint8_t { low, high };

/// Of what values are: of the prefix as it ends, or bounds over every continuation of it, which
/// docs/semantics.md defines.
enum class Reading : std::uint8_t { so_far, for_good };

/// Measurements of one step that are other than observed.
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
    /// On the prefix 0..last. `nodes`: which to evaluate, with each also its operands.
    Values(const ir::Graph& graph, const std::vector<bool>& nodes, const Observations& observations,
           std::uint64_t last, End end, Reading reading,
           const std::optional<Altered>& altered = std::nullopt);

    bool has(NodeId node) const { return node < values_.size() && !values_[node].empty(); }
    Sourced at(NodeId node, std::uint64_t position) const { return values_[node][position]; }
    /// Nothing where a value is that of an empty window, of a constant, or of what is not yet seen.
    std::optional<Sample> source(Sourced value) const;

    /// What the node would be with other measurements. Only what these change is evaluated again.
    Sourced at_with(const Altered& altered, NodeId node, std::uint64_t position);

private:
    /// What a value was before a change that is taken back.
    struct Before {
        NodeId node = 0;
        std::size_t position = 0;
        Sourced value;
    };

    Sourced constant_or_literal(const ir::Node& node, std::size_t step,
                                const std::optional<Altered>& altered) const;
    std::vector<Sourced> leaf(const ir::Node& node, const std::optional<Altered>& altered) const;
    Sourced combined(const ir::Node& node, std::size_t position) const;
    std::vector<Sourced> combination(const ir::Node& node) const;
    std::vector<Sourced> temporal(const ir::Node& node) const;
    Sourced unseen(const ir::Node& node) const;
    bool is_for_good() const { return reading_ == Reading::for_good; }

    void set(NodeId node, std::size_t position, Sourced value);
    void alter(NodeId node, const std::optional<Altered>& altered);

    const ir::Graph* graph_;
    const Observations* observations_;
    std::size_t atoms_;
    std::size_t seen_;  ///< positions of the prefix
    End end_;
    Reading reading_;
    /// [node][position]; empty: not evaluated. For good, the position after the prefix stands for
    /// all that may come: its values are the lowest, or highest, unseen ones.
    std::vector<std::vector<Sourced>> values_;
    std::vector<std::vector<std::size_t>> changed_;  ///< [node]: the positions, while altered
    std::vector<Before> before_;
};

/// These nodes and all below them.
std::vector<bool> closure(const ir::Graph& graph, const std::vector<NodeId>& roots);

}  // namespace etlc::explain
