#include "explain/support.hpp"

#include <algorithm>

namespace etlc::explain {

namespace {

bool is_literal(const ir::Node& node) {
    return node.op == ir::Op::predicate || node.op == ir::Op::flag;
}

Index atom_of(const Subject& subject, const ir::Node& literal) {
    return subject.observations.atom(literal.op == ir::Op::predicate, literal.index);
}

/// Returns whether the literal supports the status whatever the sample is.
bool always(const Subject& subject, Status status, const ir::Node& literal) {
    const etlmon::Value range = subject.observations.range(atom_of(subject, literal));
    const etlmon::Value value = literal.negated ? etlmon::negate(range) : range;
    return subject.supports(status, status == Status::satisfied ? value.low : value.high);
}

etlmon::Key constant(const ir::Node& node) {
    return node.op == ir::Op::constant_true ? etlmon::kTop : etlmon::kBottom;
}

/// Returns per atom the literals that depend on its samples.
std::vector<std::vector<NodeId>> literals_of(const Subject& subject, Status status) {
    std::vector<std::vector<NodeId>> result(subject.observations.atoms().size());
    const std::vector<bool> wanted = closure(subject.graph, {subject.root});
    for (NodeId id = 0; id <= subject.root; ++id) {
        const ir::Node& node = subject.graph[id];
        if (wanted[id] && is_literal(node) && !always(subject, status, node))
            result[atom_of(subject, node)].push_back(id);
    }
    return result;
}

/// Returns per literal and constant the steps at which it supports the status, given only the
/// samples of which some literal reaches `least`.
std::vector<std::vector<bool>> supporting_steps(const Subject& subject, const Judged& judged,
                                                const std::vector<std::vector<NodeId>>& literals,
                                                etlmon::Key least) {
    const Status status = judged.status;
    std::vector<std::vector<bool>> result(subject.root + std::size_t{1});
    for (NodeId id = 0; id <= subject.root; ++id) {
        const ir::Node& node = subject.graph[id];
        if (!node.operands.empty() || !judged.values.has(id)) continue;
        const bool always_does = is_literal(node) ? always(subject, status, node)
                                                  : subject.supports(status, constant(node));
        result[id].resize(subject.last + 2, always_does);
    }
    for (const std::vector<NodeId>& of_atom : literals)
        for (std::uint64_t step = 0; step <= subject.last && !of_atom.empty(); ++step) {
            const auto key = [&](NodeId literal) { return judged.at(literal, step).key; };
            const auto supports = [&](NodeId literal) {
                return subject.supports(status, key(literal));
            };
            const bool counts = std::any_of(of_atom.begin(), of_atom.end(), [&](NodeId literal) {
                const bool far =
                    status == Status::satisfied ? key(literal) >= least : key(literal) <= least;
                return far && supports(literal);
            });
            for (const NodeId literal : of_atom)
                result[literal][step] = counts && supports(literal);
        }
    return result;
}

}  // namespace

Support::Support(const Subject& subject, const Judged& judged, etlmon::Key least)
    : literals_(literals_of(subject, judged.status)),
      claim_({subject.graph, subject.root, subject.position, subject.last,
              judged.status == Status::satisfied, judged.reading},
             supporting_steps(subject, judged, literals_, least)) {
    for (std::uint64_t step = 0; step <= subject.last; ++step)
        for (Index atom = 0; atom < literals_.size(); ++atom)
            if (!literals({atom, step}).empty()) samples_.push_back({atom, step});
}

std::vector<NodeId> Support::literals(Sample sample) const {
    std::vector<NodeId> result;
    for (const NodeId literal : literals_[sample.atom])
        if (claim_.uses(literal, sample.step)) result.push_back(literal);
    return result;
}

std::vector<Evidence> Support::evidence(Sample sample) const {
    std::vector<Evidence> result;
    for (const NodeId literal : literals_[sample.atom]) result.push_back({literal, sample.step});
    return result;
}

}  // namespace etlc::explain
