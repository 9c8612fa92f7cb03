// The claim that a verdict is satisfied, or violated, and which samples it can do without. A sample
// that the claim needs leaves nothing changed. Withdrawing all samples costs about as much as
// visiting each pair of a position and one in its window once.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "explain/values.hpp"
#include "ir/graph.hpp"

namespace etlc::explain {

/// A literal at a step.
struct Evidence {
    NodeId literal = 0;
    std::uint64_t step = 0;
};

/// The statement that the formula `root` is satisfied, or violated, at a position of the prefix
/// 0..last, so far or for good.
struct Statement {
    const ir::Graph& graph;
    NodeId root = 0;
    std::uint64_t position = 0;
    std::uint64_t last = 0;
    bool satisfied = true;
    Semantics semantics = Semantics::so_far;

    /// Returns whether one operand, or one position of a window, suffices: so for the max of a
    /// satisfied formula and the min of a violated one.
    bool takes_one(const ir::Node& node) const;
    /// Returns whether the window at this position extends past the prefix, where the formula has
    /// to hold as well.
    bool goes_on(const ir::Node& node, std::uint64_t position) const;
    /// The position after the prefix, which stands for the unseen future.
    std::uint64_t unseen() const { return last + 1; }
};

/// Returns per node the positions, the unseen one included, that the statement reads.
std::vector<std::vector<bool>> reach(const Statement& statement);

class Claim {
public:
    /// `supports`: per node that is a literal or constant, by step, the unseen one included.
    Claim(const Statement& statement, const std::vector<std::vector<bool>>& supports);

    bool holds() const { return true_[statement_.root][statement_.position]; }
    /// Returns whether a literal is within reach, supports the claim, and has not been withdrawn.
    bool uses(NodeId literal, std::uint64_t step) const { return true_[literal][step]; }
    /// Returns whether the claim needs one of these beside the evidence that is left.
    bool needs(const std::vector<Evidence>& evidence);
    /// Withdraws them unless the claim needs them; returns whether it did.
    bool can_do_without(const std::vector<Evidence>& evidence);

private:
    /// The window of a temporal operator, as offsets in the direction of the operator.
    struct Window {
        std::uint64_t low = 0;
        std::uint64_t high = 0;  ///< cut at the end of the prefix, or at its beginning
        bool empty = false;
        bool goes_on = false;  ///< extends past the prefix
    };
    /// A fact that held before a change that may be undone.
    struct Before {
        NodeId node = 0;
        std::uint64_t position = 0;
        std::uint64_t offset = 0;
    };
    struct Parent {
        NodeId node = 0;
        bool is_last = true;  ///< the operand of the window, not the left one of an until
    };

    static constexpr std::uint64_t kNever = UINT64_MAX;

    Window window(const ir::Node& node, std::uint64_t position) const;

    void establish(NodeId id);
    bool combination(const ir::Node& node, std::uint64_t position) const;
    bool unseen(const ir::Node& node) const;
    bool search(NodeId id, std::uint64_t position, std::uint64_t from);
    bool find_witness(NodeId id, std::uint64_t position, std::uint64_t from);
    bool count(NodeId id, std::uint64_t position);
    bool has_enough(const ir::Node& node, std::uint64_t counted) const;
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
    /// [node][position] of temporal operators: the offset of the first witness of an until; of a
    /// release, that of the first true left operand, up to which the window has to hold. Of a
    /// count: at how many positions of the window the operand is true, or is not.
    std::vector<std::vector<std::uint64_t>> offsets_;
    std::vector<std::vector<Parent>> parents_;
    std::vector<std::uint64_t> first_;  ///< per node: the first and last seen position within reach
    std::vector<std::uint64_t> final_;
    std::vector<Before> changes_;
    std::vector<Evidence> refuted_;  ///< parents not yet notified
};

// The samples that support a verdict, which of them it needs, and the smallest change that would
// flip it.

class Support {
public:
    /// Considers the samples whose value is at least as far on the side of the status as `least`.
    Support(const Subject& subject, const Judged& judged, etlmon::Key least);

    /// Returns the samples by step, then atom.
    const std::vector<Sample>& samples() const { return samples_; }
    /// Returns the literals of a sample that support the status.
    std::vector<NodeId> literals(Sample sample) const;
    /// Returns whether the status needs one of these literals beside the evidence that is left.
    bool needs(const std::vector<Evidence>& literals) { return claim_.needs(literals); }
    /// Withdraws the sample unless the status needs it; returns whether it did.
    bool can_do_without(Sample sample) { return claim_.can_do_without(evidence(sample)); }

private:
    std::vector<Evidence> evidence(Sample sample) const;

    std::vector<std::vector<NodeId>> literals_;  ///< per atom, those that depend on its samples
    Claim claim_;
    std::vector<Sample> samples_;
};

/// Returns the smallest change of one measurement behind the samples that flips the verdict; a bool
/// only where no other measurement does. Alters the values meanwhile and restores them.
std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples);

}  // namespace etlc::explain
