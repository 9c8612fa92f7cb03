#include "explain/explain.hpp"

#include <algorithm>

#include "etlmon/temporal/shift.hpp"
#include "explain/claim.hpp"

namespace etlc::explain {

namespace {

using check::Formula;
using Kind = Formula::Kind;

/// Whether a formula contains its operand `n`, its negation, or both.
struct Polarities {
    bool plain = true;
    bool negated = false;
};
Polarities polarities(const Formula& formula, std::size_t n) {
    switch (formula.kind) {
        case Kind::negation: return {false, true};
        case Kind::implication: return {n == 1, n == 0};
        case Kind::count: return {true, !formula.each_step};
        case Kind::equivalence:
        case Kind::rise:
        case Kind::fall: return {true, true};
        default: return {};
    }
}

/// The positions at which a formula reads an operand, in 0..seen - 1; `seen` itself stands for the
/// unseen future.
struct Span {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
};
Span looked_at(const Formula& formula, std::uint64_t position, std::uint64_t seen) {
    if (check::looks_ahead(formula.kind))
        return {position, std::min<std::uint64_t>(seen, position + formula.high)};
    if (!check::looks_back(formula.kind)) return {position, position};
    if (position == seen) return {0, seen};
    return {position - std::min<std::uint64_t>(position, check::steps_back(formula)), position};
}

/// Builds the chain from the monitor's formula down, always to an operand that has the monitor's
/// value. The sample is part of the value, so that is the operand which the value comes from.
class Chain {
public:
    Chain(const ir::Program& program, const Subject& subject, const Judged& judged)
        : program_(program),
          subject_(subject),
          judged_(judged),
          root_(judged.at(subject.root, subject.position)) {}

    std::vector<Link> from(Index formula) const {
        std::vector<Link> chain;
        std::optional<Place> place{{formula, false, subject_.position}};
        for (; place; place = below(*place)) {
            chain.push_back({place->formula, place->position,
                             etlmon::float_of(place->negated ? -root_.key : root_.key)});
        }
        return chain;
    }

private:
    struct Place {
        Index formula = 0;
        bool negated = false;
        std::uint64_t position = 0;
    };

    std::optional<Place> below(const Place& place) const {
        const Formula& formula = subject_.graph.model().formulas[place.formula];
        const Span span = looked_at(formula, place.position, subject_.last + 1);
        const std::uint64_t last_position =
            subject_.last + (judged_.semantics == Semantics::for_good ? 1 : 0);
        for (std::size_t n = 0; n < formula.operands.size(); ++n) {
            const Polarities has = polarities(formula, n);
            for (const bool flipped : {false, true}) {
                if (!(flipped ? has.negated : has.plain)) continue;
                const bool negated = place.negated != flipped;
                const NodeId node = program_.formulas[negated ? 1 : 0][formula.operands[n]];
                if (node == check::kNone || !judged_.values.has(node)) continue;
                const std::uint64_t last = std::min(span.last, last_position);
                for (std::uint64_t k = span.first; k <= last; ++k)
                    if (judged_.at(node, k) == root_) return Place{formula.operands[n], negated, k};
            }
        }
        return std::nullopt;
    }

    const ir::Program& program_;
    const Subject& subject_;
    const Judged& judged_;
    const Sourced root_;
};

/// Returns the nodes of the formula and of all formulas in it.
std::vector<bool> nodes_of(const ir::Program& program, Index formula) {
    std::vector<bool> inside(formula + std::size_t{1});
    inside[formula] = true;
    std::vector<NodeId> nodes;
    for (Index f = formula + 1; f-- > 0;) {
        if (!inside[f]) continue;
        for (const Index operand : program.graph.model().formulas[f].operands)
            inside[operand] = true;
        for (const auto& of_formula : program.formulas)
            if (of_formula[f] != check::kNone) nodes.push_back(of_formula[f]);
    }
    return closure(program.graph, nodes);
}

}  // namespace

Explanation explain(const ir::Program& program, const Observations& observations,
                    const Question& question) {
    const check::Monitor& monitor = observations.model().monitors[question.monitor];
    const Subject subject{program.graph,
                          observations,
                          program.monitors[question.monitor],
                          nodes_of(program, monitor.formula),
                          question.position,
                          question.step,
                          monitor.calibration ? monitor.calibration->low() : 0,
                          monitor.calibration ? monitor.calibration->value : 0};
    Judged judged = judge(subject);
    Explanation result;
    result.status = judged.status;
    if (judged.status == Status::unknown) {
        for (const Sample& sample : unknown_samples(subject))
            (observations.is_missing(sample) ? result.missing : result.between).push_back(sample);
        return result;
    }
    result.for_good = judged.semantics == Semantics::for_good;
    const Sourced root = judged.at(subject.root, subject.position);
    result.robustness = etlmon::float_of(Subject::end_of(
        root.key, judged.status == Status::satisfied ? subject.low_shift : subject.high_shift));
    result.critical = judged.values.source(root);
    result.chain = Chain(program, subject, judged).from(monitor.formula);
    result.samples = needed_samples(subject, judged, root.key, result.critical);
    result.change = smallest_change(subject, judged, result.samples);
    return result;
}

}  // namespace etlc::explain
