#include "explain/claim.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace etlc::explain {

namespace {

using etlmon::Key;

/// A set of positions, built from ranges.
class Ranges {
public:
    explicit Ranges(std::uint64_t length) : changes_(length + 1) {}

    /// first..end - 1
    void add(std::uint64_t first, std::uint64_t end) {
        if (first >= end) return;
        ++changes_[first];
        --changes_[end];
    }
    std::vector<bool> positions() const {
        std::vector<bool> result(changes_.size() - 1);
        std::int64_t depth = 0;
        for (std::size_t n = 0; n < result.size(); ++n) {
            depth += changes_[n];
            result[n] = depth > 0;
        }
        return result;
    }

private:
    std::vector<std::int64_t> changes_;
};

bool is_temporal(const ir::Node& node) {
    return ir::info(node.op).tense != ir::Tense::now;
}

bool is_past(const ir::Node& node) {
    return ir::info(node.op).tense == ir::Tense::past;
}

/// Returns the position that the operator sees at this offset.
std::uint64_t at(const ir::Node& node, std::uint64_t position, std::uint64_t offset) {
    return is_past(node) ? position - offset : position + offset;
}

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
    bool takes_one(const ir::Node& node) const {
        return (ir::takes_max(node.op) || node.op == ir::Op::disjunction) == satisfied;
    }
    /// Returns whether the window at this position extends past the prefix, where the formula has
    /// to hold as well.
    bool goes_on(const ir::Node& node, std::uint64_t at) const {
        return semantics == Semantics::for_good && !is_past(node) && !takes_one(node) &&
               node.interval.high > last - at;
    }
    /// The position after the prefix, which stands for the unseen future.
    std::uint64_t unseen() const { return last + 1; }
};

/// Finds the positions that the statement reads, the unseen one included, per node, from the root
/// down.
class Reach {
public:
    explicit Reach(const Statement& statement)
        : statement_(statement),
          ranges_(statement.root + std::size_t{1}, Ranges(statement.last + 2)) {}

    std::vector<std::vector<bool>> find() {
        std::vector<std::vector<bool>> result(ranges_.size());
        add(statement_.root, statement_.position, statement_.position + 1);
        for (NodeId id = statement_.root + 1; id-- > 0;) {
            result[id] = ranges_[id].positions();
            const ir::Node& node = statement_.graph[id];
            if (node.operands.empty()) continue;
            for (std::uint64_t k = 0; k <= statement_.unseen(); ++k)
                if (result[id][k]) look_from(node, k);
        }
        return result;
    }

private:
    void add(NodeId node, std::uint64_t first, std::uint64_t end) { ranges_[node].add(first, end); }

    void look_from(const ir::Node& node, std::uint64_t k) {
        if (!is_temporal(node))
            for (const NodeId operand : node.operands) add(operand, k, k + 1);
        else if (k == statement_.unseen())
            look_from_unseen(node);
        else if (is_past(node))
            look_back(node, k);
        else
            look_ahead(node, k);
    }

    void look_back(const ir::Node& node, std::uint64_t k) {
        if (node.interval.low > k) return;
        const std::uint64_t high = std::min<std::uint64_t>(node.interval.high, k);
        add(node.operands.back(), k - high, k - node.interval.low + 1);
        if (node.operands.size() == 2) add(node.operands.front(), k - high + 1, k + 1);
    }

    void look_ahead(const ir::Node& node, std::uint64_t k) {
        const std::uint64_t room = statement_.last - k;
        const bool goes_on = statement_.goes_on(node, k);
        if (node.interval.low > room && !goes_on) return;
        const std::uint64_t high = std::min<std::uint64_t>(node.interval.high, room);
        add(node.operands.back(), k + node.interval.low, k + high + 1);
        if (goes_on) add(node.operands.back(), statement_.unseen(), statement_.unseen() + 1);
        if (node.operands.size() == 2) add(node.operands.front(), k, k + high + (goes_on ? 1 : 0));
    }

    void look_from_unseen(const ir::Node& node) {
        const std::uint64_t end = statement_.unseen() + 1;
        add(node.operands.back(), is_past(node) ? 0 : statement_.unseen(), end);
    }

    const Statement& statement_;
    std::vector<Ranges> ranges_;
};

/// The claim that a statement is true, and the evidence that it can do without. Evidence that the
/// claim needs leaves nothing changed. Withdrawing all costs about as much as visiting each pair of
/// a position and one in its window once.
class Claim {
public:
    /// `supports`: per node that is a literal or constant, by step, the unseen one included.
    Claim(const Statement& statement, const std::vector<std::vector<bool>>& supports)
        : statement_(statement),
          graph_(statement.graph),
          true_(Reach(statement).find()),
          offsets_(true_.size()),
          parents_(true_.size()),
          first_(true_.size(), kNever),
          final_(true_.size(), 0) {
        for (NodeId id = 0; id < true_.size(); ++id) {
            const ir::Node& node = graph_[id];
            for (std::uint64_t k = 0; k <= statement.last; ++k) {
                if (!true_[id][k]) continue;
                first_[id] = std::min(first_[id], k);
                final_[id] = k;
            }
            if (first_[id] == kNever && !true_[id][statement.unseen()]) continue;
            for (std::size_t n = 0; n < node.operands.size(); ++n)
                parents_[node.operands[n]].push_back({id, n + 1 == node.operands.size()});
            if (!node.operands.empty()) {
                establish(id);
                continue;
            }
            for (std::uint64_t k = 0; k <= statement.unseen(); ++k)
                true_[id][k] = true_[id][k] && supports[id][k];
        }
    }

    /// Returns whether a literal is within reach, supports the claim, and has not been withdrawn.
    bool uses(NodeId literal, std::uint64_t step) const { return true_[literal][step]; }

    /// Returns whether the claim needs one of these beside the evidence that is left.
    bool needs(const std::vector<Evidence>& evidence) {
        const bool still_true = withdraw(evidence);
        take_back();
        return !still_true;
    }

    /// Withdraws them unless the claim needs them; returns whether it did.
    bool can_do_without(const std::vector<Evidence>& evidence) {
        const bool still_true = withdraw(evidence);
        if (!still_true) take_back();
        changes_.clear();
        return still_true;
    }

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

    bool holds() const { return true_[statement_.root][statement_.position]; }

    Window window(const ir::Node& node, std::uint64_t position) const {
        const std::uint64_t room = is_past(node) ? position : statement_.last - position;
        return {node.interval.low, std::min<std::uint64_t>(node.interval.high, room),
                node.interval.low > room, statement_.goes_on(node, position)};
    }

    // ---- what is true to begin with -------------------------------------------------------------

    void establish(NodeId id) {
        const ir::Node& node = graph_[id];
        const bool temporal = is_temporal(node);
        const std::uint64_t unseen_position = statement_.unseen();
        if (temporal) offsets_[id].resize(unseen_position + 1);
        for (std::uint64_t k = 0; k <= unseen_position; ++k)
            if (true_[id][k])
                true_[id][k] = !temporal              ? combination(node, k)
                               : k == unseen_position ? unseen(node)
                                                      : search(id, k, 0);
    }

    bool combination(const ir::Node& node, std::uint64_t position) const {
        const bool one = statement_.takes_one(node);
        for (const NodeId operand : node.operands)
            if (true_[operand][position] == one) return one;
        return !one;
    }

    /// Evaluates the position that stands for the unseen future, as Values does.
    bool unseen(const ir::Node& node) const {
        const bool one = statement_.takes_one(node);
        if (one && (node.interval.low > 0 || ir::counts(node.op))) return false;
        const std::vector<bool>& operand = true_[node.operands.back()];
        const bool never_forgets = node.operands.size() == 1 && !node.interval.bounded();
        const bool now = operand[statement_.unseen()];
        if (now == one || !is_past(node) || (one && !never_forgets)) return now;
        const auto seen_end = operand.begin() + static_cast<std::ptrdiff_t>(statement_.unseen());
        return (std::find(operand.begin(), seen_end, one) != seen_end) == one;
    }

    bool search(NodeId id, std::uint64_t position, std::uint64_t from) {
        if (ir::counts(graph_[id].op)) return count(id, position);
        return statement_.takes_one(graph_[id]) ? find_witness(id, position, from)
                                                : find_release(id, position, from);
    }

    /// Counts the positions of the window at which the operand is true; where one position would
    /// not suffice, those at which it is not.
    bool count(NodeId id, std::uint64_t position) {
        const ir::Node& node = graph_[id];
        const bool one = statement_.takes_one(node);
        const Window w = window(node, position);
        std::uint64_t counted = 0;
        for (std::uint64_t o = w.low; o <= w.high; ++o)
            counted += true_[node.operands[0]][at(node, position, o)] == one ? 1 : 0;
        offsets_[id][position] = counted;
        return has_enough(node, counted);
    }

    bool has_enough(const ir::Node& node, std::uint64_t counted) const {
        return (counted >= node.index) == statement_.takes_one(node);
    }

    /// Finds the first offset of the window, at or after `from`, at which the last operand is true,
    /// with the left one true up to there. Before `from` the left one is known to be true.
    bool find_witness(NodeId id, std::uint64_t position, std::uint64_t from) {
        const ir::Node& node = graph_[id];
        const Window w = window(node, position);
        if (w.empty) return false;
        const std::vector<bool>& last = true_[node.operands.back()];
        const bool binary = node.operands.size() == 2;
        const std::vector<bool>& left = true_[node.operands.front()];
        for (std::uint64_t o = binary ? from : std::max(from, w.low); o <= w.high; ++o) {
            if (o >= w.low && last[at(node, position, o)]) {
                offsets_[id][position] = o;
                return true;
            }
            if (binary && !left[at(node, position, o)]) return false;
        }
        return false;
    }

    /// Finds the first offset, at or after `from`, at which the left operand is true. Up to it the
    /// last one has to be true in the window; without it, in all of the window and after the
    /// prefix. Before `from` the last one is known to be true.
    bool find_release(NodeId id, std::uint64_t position, std::uint64_t from) {
        const ir::Node& node = graph_[id];
        const Window w = window(node, position);
        offsets_[id][position] = kNever;
        if (w.empty && !w.goes_on) return true;
        const std::vector<bool>& last = true_[node.operands.back()];
        const bool binary = node.operands.size() == 2;
        const std::vector<bool>& left = true_[node.operands.front()];
        for (std::uint64_t o = binary ? from : std::max(from, w.low); o <= w.high; ++o) {
            if (o >= w.low && !last[at(node, position, o)]) return false;
            if (binary && (o < w.high || w.goes_on) && left[at(node, position, o)]) {
                offsets_[id][position] = o;
                return true;
            }
        }
        return !w.goes_on || last[statement_.unseen()];
    }

    // ---- without some of it ---------------------------------------------------------------------

    bool withdraw(const std::vector<Evidence>& evidence) {
        for (const Evidence& e : evidence) refute(e.literal, e.step);
        while (!refuted_.empty() && holds()) {
            const Evidence next = refuted_.back();
            refuted_.pop_back();
            for (const Parent& parent : parents_[next.literal]) tell(parent, next.step);
        }
        refuted_.clear();
        return holds();
    }

    void refute(NodeId id, std::uint64_t position) {
        if (!true_[id][position]) return;
        const std::uint64_t offset = offsets_[id].empty() ? 0 : offsets_[id][position];
        changes_.push_back({id, position, offset});
        true_[id][position] = false;
        refuted_.push_back({id, position});
    }

    /// Tells a parent that the operand is no longer true at this position.
    void tell(const Parent& parent, std::uint64_t position) {
        const ir::Node& node = graph_[parent.node];
        if (!is_temporal(node)) {
            if (true_[parent.node][position] && !combination(node, position))
                refute(parent.node, position);
            return;
        }
        if (parent.is_last && true_[parent.node][statement_.unseen()] && !unseen(node))
            refute(parent.node, statement_.unseen());
        if (position == statement_.unseen()) return tell_of_unseen(parent);
        const std::uint64_t room = is_past(node) ? statement_.last - position : position;
        const std::uint64_t low = parent.is_last ? node.interval.low : 0;
        const std::uint64_t high = std::min<std::uint64_t>(node.interval.high, room);
        if (low > high) return;
        // the positions within reach that see this one at an offset in [low, high]
        std::uint64_t from = is_past(node) ? position + low : position - high;
        std::uint64_t to = is_past(node) ? position + high : position - low;
        from = std::max(from, first_[parent.node]);
        to = std::min(to, final_[parent.node]);
        for (std::uint64_t k = from; k <= to && holds(); ++k)
            if (true_[parent.node][k])
                reconsider(parent, k, is_past(node) ? k - position : position - k);
    }

    /// Tells a parent that the operand is no longer true after the prefix.
    void tell_of_unseen(const Parent& parent) {
        const ir::Node& node = graph_[parent.node];
        if (!parent.is_last) return;
        for (std::uint64_t k = first_[parent.node]; k <= final_[parent.node] && k != kNever; ++k)
            if (true_[parent.node][k] && statement_.goes_on(node, k) &&
                offsets_[parent.node][k] == kNever)
                refute(parent.node, k);
    }

    /// Searches again, because the operand is no longer true at this offset from the position.
    void reconsider(const Parent& parent, std::uint64_t position, std::uint64_t offset) {
        const NodeId id = parent.node;
        const std::uint64_t known = offsets_[id][position];
        const bool one = statement_.takes_one(graph_[id]);
        if (ir::counts(graph_[id].op)) {
            const std::uint64_t counted = one ? known - 1 : known + 1;
            if (!has_enough(graph_[id], counted)) return refute(id, position);
            changes_.push_back({id, position, known});
            offsets_[id][position] = counted;
            return;
        }
        if (parent.is_last != one) {  // an operand that has to be true up to the known offset
            if (one ? offset < known : offset <= known) refute(id, position);
            return;
        }
        if (offset != known) return;
        if (search(id, position, one ? offset : offset + 1)) {
            changes_.push_back({id, position, known});
            return;
        }
        offsets_[id][position] = known;
        refute(id, position);
    }

    void take_back() {
        for (; !changes_.empty(); changes_.pop_back()) {
            const Before& before = changes_.back();
            true_[before.node][before.position] = true;
            if (!offsets_[before.node].empty())
                offsets_[before.node][before.position] = before.offset;
        }
    }

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

/// The samples that support a verdict, and which of them it needs.
class Support {
public:
    /// Considers the samples whose value is at least as far on the side of the status as `least`.
    Support(const Subject& subject, const Judged& judged, etlmon::Key least)
        : literals_(literals_of(subject, judged.status)),
          claim_({subject.graph, subject.root, subject.position, subject.last,
                  judged.status == Status::satisfied, judged.semantics},
                 supporting_steps(subject, judged, literals_, least)) {
        for (std::uint64_t step = 0; step <= subject.last; ++step)
            for (Index atom = 0; atom < literals_.size(); ++atom)
                if (!literals({atom, step}).empty()) samples_.push_back({atom, step});
    }

    /// Returns the samples by step, then atom.
    const std::vector<Sample>& samples() const { return samples_; }

    /// Returns the literals of a sample that support the status.
    std::vector<NodeId> literals(Sample sample) const {
        std::vector<NodeId> result;
        for (const NodeId literal : literals_[sample.atom])
            if (claim_.uses(literal, sample.step)) result.push_back(literal);
        return result;
    }

    /// Returns whether the status needs one of these literals beside the evidence that is left.
    bool needs(const std::vector<Evidence>& literals) { return claim_.needs(literals); }

    /// Withdraws the sample unless the status needs it; returns whether it did.
    bool can_do_without(Sample sample) {
        std::vector<Evidence> evidence;
        for (const NodeId literal : literals_[sample.atom])
            evidence.push_back({literal, sample.step});
        return claim_.can_do_without(evidence);
    }

private:
    std::vector<std::vector<NodeId>> literals_;  ///< per atom, those that depend on its samples
    Claim claim_;
    std::vector<Sample> samples_;
};

std::vector<Sample> in_order(std::vector<Sample> samples) {
    std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
        return std::pair(a.step, a.atom) < std::pair(b.step, b.atom);
    });
    return samples;
}

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
                          then.semantics == Semantics::for_good};
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
        etlmon::Value value = subject_.observations.value(atom, measured);
        if (subject_.graph[literal].negated) value = etlmon::negate(value);
        return subject_.supports(status_, status_ == Status::satisfied ? value.low : value.high);
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

std::vector<Sample> needed_samples(const Subject& subject, const Judged& judged, Key least,
                                   const std::optional<Sample>& critical) {
    Support support(subject, judged, least);
    std::vector<Sample> order = support.samples();
    std::reverse(order.begin(), order.end());
    std::stable_partition(order.begin(), order.end(),
                          [&](const Sample& sample) { return sample != critical; });
    std::vector<Sample> kept;
    for (const Sample& sample : order)
        if (!support.can_do_without(sample)) kept.push_back(sample);
    return in_order(std::move(kept));
}

std::vector<Sample> unknown_samples(const Subject& subject) {
    const Statement statement{subject.graph, subject.root, subject.position, subject.last};
    const auto reached = Reach(statement).find();
    std::vector<Sample> result;
    for (Index atom = 0; atom < subject.observations.atoms().size(); ++atom)
        for (std::uint64_t step = 0; step <= subject.last; ++step) {
            if (!subject.observations.is_looked_at(atom) ||
                !(subject.observations.is_missing({atom, step}) ||
                  subject.observations.is_between({atom, step})))
                continue;
            bool seen = false;
            for (NodeId id = 0; id <= subject.root && !seen; ++id) {
                const ir::Node& node = subject.graph[id];
                seen = (node.op == ir::Op::predicate || node.op == ir::Op::flag) &&
                       reached[id][step] &&
                       subject.observations.atom(node.op == ir::Op::predicate, node.index) == atom;
            }
            if (seen) result.push_back({atom, step});
        }
    return in_order(std::move(result));
}

std::optional<Change> smallest_change(const Subject& subject, Judged& judged,
                                      const std::vector<Sample>& samples) {
    return Search(subject, judged).among(samples);
}

}  // namespace etlc::explain
