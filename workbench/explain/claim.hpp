// That a verdict is satisfied, or that it is violated, and which samples the claim can do without.
// Takes: the graph, and of every literal where it speaks for the claim. Gives: after samples are
// taken away, whether the rest still makes the claim true. Keeps true: a sample that is refused
// leaves nothing changed; taking all samples away costs about as much as looking at each pair of a
// position and one in its window once.
#pragma once

#include <cstdint>
#include <vector>

#include "explain/values.hpp"
#include "ir/graph.hpp"

namespace etlc::explain {

/// A literal at a step.
struct Evidence {
    NodeId literal = 0;
    std::uint64_t step = 0;
};

/// That the formula `root` is satisfied, or violated, at a position of the prefix 0..last, so far
/// or for good.
struct Statement {
    const ir::Graph& graph;
    NodeId root = 0;
    std::uint64_t position = 0;
    std::uint64_t last = 0;
    bool satisfied = true;
    Reading reading = Reading::so_far;

    /// Whether it takes one operand, or one position of a window, and not all: so with the max of a
    /// formula that is satisfied, and the min of one that is violated.
    bool takes_one(const ir::Node& node) const;
    /// Whether the window at this position goes on after the prefix, where it has to hold as well.
    bool goes_on(const ir::Node& node, std::uint64_t position) const;
    /// The position after the prefix, which stands for all that may come.
    std::uint64_t unseen() const { return last + 1; }
};

/// Per node, the positions, the unseen one included, that the statement looks at.
std::vector<std::vector<bool>> reach(const Statement& statement);

class Claim {
public:
    /// `speaks_for_it`: per node that is a literal or constant, by step, the unseen one included.
    Claim(const Statement& statement, const std::vector<std::vector<bool>>& speaks_for_it);

    bool holds() const { return true_[statement_.root][statement_.position]; }
    /// Whether a literal is within reach, speaks for the claim, and has not been taken away.
    bool uses(NodeId literal, std::uint64_t step) const { return true_[literal][step]; }
    /// Whether the claim needs one of these, beside what else is still there.
    bool needs(const std::vector<Evidence>& evidence);
    /// Takes them away unless it does.
    bool can_do_without(const std::vector<Evidence>& evidence);

private:
    /// The positions of a temporal operator, as offsets into the direction that it looks.
    struct Window {
        std::uint64_t low = 0;
        std::uint64_t high = 0;  ///< cut at the end of the prefix, or at its beginning
        bool empty = false;
        bool goes_on = false;  ///< after the prefix
    };
    /// What was so before a change that may be taken back.
    struct Before {
        NodeId node = 0;
        std::uint64_t position = 0;
        std::uint64_t offset = 0;
    };
    struct Parent {
        NodeId node = 0;
        bool is_last = true;  ///< the operand of its window, not the left one of an until
    };

    static constexpr std::uint64_t kNever = UINT64_MAX;

    Window window(const ir::Node& node, std::uint64_t position) const;

    void establish(NodeId id);
    bool combination(const ir::Node& node, std::uint64_t position) const;
    bool unseen(const ir::Node& node) const;
    bool search(NodeId id, std::uint64_t position, std::uint64_t from);
    bool find_witness(NodeId id, std::uint64_t position, std::uint64_t from);
    bool find_release(NodeId id, std::uint64_t position, std::uint64_t from);

    bool withdraw(const std::vector<Evidence>& evidence);
    void refute(NodeId id, std::uint64_t position);
    void tell(const Parent& parent, std::uint64_t position);
    void tell_of_unseen(const Parent& parent);
    void reconsider(const Parent& parent, std::uint64_t position, std::uint64_t offset);
    void take_back();

    const Statement statement_;
    const ir::Graph& graph_;
    std::vector<std::vector<bool>> true_;  ///< [node][position]; false also where out of reach
    /// [node][position], of temporal operators: the offset of what makes them true. Of an until, of
    /// its first witness; of a release, of the first left operand, up to which the window holds.
    std::vector<std::vector<std::uint64_t>> offsets_;
    std::vector<std::vector<Parent>> parents_;
    std::vector<std::uint64_t> first_;  ///< per node: the first and last seen position within reach
    std::vector<std::uint64_t> final_;
    std::vector<Before> changes_;
    std::vector<Evidence> refuted_;  ///< whose parents have not been told
};

}  // namespace etlc::explain
