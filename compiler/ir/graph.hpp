// The formulas of all monitors as one hash-consed graph in negation normal form: equal formulas are
// one node. Operands have smaller ids; only predicates and flags are negated; && and || are flat,
// sorted and without repeats. The laws applied by the builders (graph.cpp) hold for min and max on
// every prefix, so p && !p stays.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::ir {

using NodeId = std::uint32_t;
using check::Index;
using check::kUnbounded;
using source::Span;

enum class Op : std::uint8_t {
#define OPERATOR(name, symbol, arity, tense, dual) name,
#include "ir/operators.def"
#undef OPERATOR
};

enum class Arity : std::uint8_t { atom, unary, binary, many };
enum class Tense : std::uint8_t { now, future, past };

/// One row of operators.def.
struct OpInfo {
    const char* name;
    const char* symbol;
    Arity arity;
    Tense tense;
    Op dual;
};
const OpInfo& info(Op op);
/// Returns whether the operator is a max over positions, false over none: F, U, O and S, and the
/// n-th greatest of at_least. The other temporal operators are mins, true over none.
bool takes_max(Op op);
/// Returns whether it is one of a count: its operand holds at n or more positions of the interval,
/// or fails at fewer than n.
bool counts(Op op);

/// Steps from the present: [low, high], or [low, inf).
struct Interval {
    std::uint32_t low = 0;
    std::uint32_t high = kUnbounded;

    bool operator==(const Interval&) const = default;
    bool contains(Interval other) const { return low <= other.low && other.high <= high; }
    bool bounded() const { return high != kUnbounded; }
    /// Returns the window as seen one step later; low and high must not be 0.
    Interval earlier() const { return {low == 0 ? 0 : low - 1, bounded() ? high - 1 : high}; }
};

/// The f of count(f, D), or of fraction(f, D), which counts each step at which it holds.
struct Counted {
    NodeId formula = check::kNone;
    bool each_step = false;
};

struct Node {
    Op op = Op::constant_true;
    bool negated = false;  ///< predicate and flag only
    /// predicate: of the model's predicates; flag: of its inputs; at_least, all_but: n
    Index index = 0;
    Interval interval{};  ///< of temporal operators
    std::vector<NodeId> operands;
    bool has_future = false;      ///< contains a future operator, or is one
    bool unbounded_past = false;  ///< contains an unbounded past operator, or is one
    std::uint32_t horizon = 0;    ///< steps of future that it needs; kUnbounded without bound
    Span span{};                  ///< first mention in the spec; not part of its identity
    Counted counted{};            ///< of a count; not part of its identity

    bool same_as(const Node& other) const;
};

class Graph {
public:
    explicit Graph(const check::Model& model);

    const check::Model& model() const { return *model_; }
    const Node& operator[](NodeId id) const { return nodes_[id]; }
    std::size_t size() const { return nodes_.size(); }

    NodeId constant(bool value) const { return value ? 0 : 1; }
    NodeId literal(Op op, Index index, bool negated, Span span);
    /// Builds && or || of any number of operands: flattened and sorted, without constants and
    /// absorbed operands.
    NodeId combine(Op op, std::vector<NodeId> operands, Span span);
    NodeId unary(Op op, Interval interval, NodeId operand, Span span);
    /// Builds at_least or all_but: n of the positions of [0, high]. The operand says where
    /// what is counted begins to hold or, for all_but, where it does not.
    NodeId count(Op op, std::uint32_t n, std::uint32_t high, NodeId operand, Counted counted,
                 Span span);
    NodeId binary(Op op, Interval interval, NodeId left, NodeId right, Span span);
    /// Builds a temporal operator without applying laws: F[0,0] f is f, but an obligation for the
    /// next position also needs the value where the prefix ends before.
    NodeId keep(Op op, Interval interval, std::vector<NodeId> operands, Span span);

    /// Prints the formula for people, with symbols and names: "F (at_a && F at_b)". Long ones are
    /// abbreviated (check/model/elision.hpp).
    std::string text(NodeId id) const;
    /// Prints the formula if it needs no abbreviation; returns nothing otherwise, quickly, however
    /// long the formula is.
    std::string short_text(NodeId id) const;

private:
    NodeId intern(Node node);
    std::vector<NodeId> absorb(Op op, std::vector<NodeId> operands) const;

    const check::Model* model_;
    std::vector<Node> nodes_;
    std::unordered_map<std::size_t, std::vector<NodeId>> by_hash_;
};

/// Asserts the invariants of the graph.
void verify(const Graph& graph);

}  // namespace etlc::ir
