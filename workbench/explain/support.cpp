#include "explain/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

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

// ---- the smallest change ------------------------------------------------------------------------
// Finds the smallest change of one measurement that flips a verdict. Candidates are the points at
// which a literal changes its truth, tried in order of size: by bisection over the floats for an
// order comparison, at and beside the threshold for == and !=.

namespace {

using etlmon::Key;

class Search {
public:
    Search(const Subject& subject, Judged& judged)
        : subject_(subject), judged_(judged), status_(judged.status) {}

    std::optional<Change> among(const std::vector<Sample>& samples) {
        const Key weakest = status_ == Status::satisfied ? etlmon::kBottom : etlmon::kTop;
        Support support(subject_, judged_, weakest);
        std::set<std::pair<std::uint64_t, Index>> seen;  // step and first atom
        for (const Sample& sample : samples) {
            if (subject_.observations.is_missing(sample)) continue;
            const std::vector<Index> atoms = of_same_measurement(sample.atom);
            if (!seen.insert({sample.step, atoms.front()}).second) continue;
            add_candidates(sample, atoms, support);
        }
        std::stable_sort(candidates_.begin(), candidates_.end(),
                         [](const Candidate& a, const Candidate& b) { return a.size < b.size; });
        for (const Candidate& candidate : candidates_) {
            if (!turns(candidate.altered)) continue;
            const Judged then = judge(subject_, &candidate.altered);
            return Change{candidate.sample, candidate.altered.measured, then.status,
                          then.reading == Reading::for_good};
        }
        return std::nullopt;
    }

private:
    struct Candidate {
        double size = 0;
        Sample sample;
        Altered altered;
    };

    /// Returns whether the status is lost; of a verdict that is final, whether finality is.
    bool turns(const Altered& altered) {
        const Bounds root = judged_.values.at_with(altered, subject_.root, subject_.position);
        return !subject_.supports(status_, judged_.deciding(root).key);
    }

    /// Returns the atoms that compare the same distance or expression, or read the same bool.
    std::vector<Index> of_same_measurement(Index atom) {
        const Observations& observed = subject_.observations;
        if (expressions_.empty())
            for (Index a = 0; a < observed.atoms().size(); ++a)
                expressions_.push_back(
                    observed.atoms()[a].is_predicate
                        ? check::print(observed.model(), observed.predicate(a).expression)
                        : "");
        if (!observed.atoms()[atom].is_predicate) return {atom};
        std::vector<Index> result;
        for (Index a = 0; a < expressions_.size(); ++a)
            if (expressions_[a] == expressions_[atom]) result.push_back(a);
        return result;
    }

    /// Adds the points at which a literal stops supporting the status. A literal of == or != may
    /// start to support it on the way, so all of its points are tried.
    void add_candidates(Sample sample, const std::vector<Index>& atoms, Support& support) {
        const Observations& observed = subject_.observations;
        const float measured = observed.measured(sample);
        if (!observed.atoms()[sample.atom].is_predicate) {
            add({kInfinity, sample, {sample.step, atoms, measured != 0 ? 0.0F : 1.0F}}, support);
            return;
        }
        std::set<float> tried;
        const auto try_with = [&](float other) {
            if (other == measured || !tried.insert(other).second) return;
            const double size = static_cast<double>(other) - static_cast<double>(measured);
            add({std::abs(size), sample, {sample.step, atoms, other}}, support);
        };
        for (const Index atom : atoms) {
            if (observed.predicate(atom).equality()) {
                for (const float other : points_of_equality(atom)) try_with(other);
                continue;
            }
            for (const NodeId literal : support.literals({atom, sample.step}))
                for (const bool up : {false, true})
                    if (const auto other = turning_point(literal, atom, measured, up))
                        try_with(*other);
        }
    }

    /// Returns the threshold, where == holds alone, and the floats beside it, as far as the range
    /// of the expression allows.
    std::vector<float> points_of_equality(Index atom) const {
        constexpr float kEnd = std::numeric_limits<float>::infinity();
        const check::Predicate& predicate = subject_.observations.predicate(atom);
        const float threshold = predicate.threshold.value + 0.0F;  // turns -0 into 0
        std::vector<float> points;
        for (const float point :
             {threshold, std::nextafter(threshold, -kEnd), std::nextafter(threshold, kEnd)})
            if (std::isfinite(point) && predicate.delta.contains(point)) points.push_back(point);
        return points;
    }

    /// Adds a candidate, unless the status holds without the literals that it falsifies.
    void add(Candidate candidate, Support& support) {
        std::vector<Evidence> lost;
        for (const Index atom : candidate.altered.atoms)
            for (const NodeId literal : support.literals({atom, candidate.sample.step}))
                if (!supports(literal, atom, candidate.altered.measured))
                    lost.push_back({literal, candidate.sample.step});
        if (support.needs(lost)) candidates_.push_back(std::move(candidate));
    }

    bool supports(NodeId literal, Index atom, float measured) const {
        const etlmon::Value value = subject_.observations.value(atom, measured);
        return subject_.supports(status_, subject_.graph[literal].negated ? -value.low : value.low);
    }

    /// Returns the first number above or below at which the literal no longer supports the status.
    std::optional<float> turning_point(NodeId literal, Index atom, float measured, bool up) const {
        const auto still = [&](std::int64_t delta) {
            return supports(literal, atom, etlmon::float_of(static_cast<Key>(delta)));
        };
        const check::Range& range = subject_.observations.predicate(atom).delta;
        constexpr float kGreatest = std::numeric_limits<float>::max();
        std::int64_t other =
            etlmon::key_of(up ? std::min(range.high, kGreatest) : std::max(range.low, -kGreatest));
        std::int64_t same = etlmon::key_of(measured);
        if ((up ? other <= same : other >= same) || still(other)) return std::nullopt;
        while (std::abs(other - same) > 1) {
            const std::int64_t middle = same + (other - same) / 2;
            (still(middle) ? same : other) = middle;
        }
        return etlmon::float_of(static_cast<Key>(other));
    }

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    const Subject& subject_;
    Judged& judged_;
    Status status_;
    std::vector<std::string> expressions_;  ///< per atom
    std::vector<Candidate> candidates_;
};

}  // namespace

std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples) {
    return Search(subject, judged).among(samples);
}

}  // namespace etlc::explain
