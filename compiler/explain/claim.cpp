#include "explain/claim.hpp"

#include <algorithm>
#include <utility>

namespace etlc::explain {

namespace {

/// Positions, given as ranges.
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

/// The position that is seen at this offset.
std::uint64_t at(const ir::Node& node, std::uint64_t position, std::uint64_t offset) {
    return is_past(node) ? position - offset : position + offset;
}

}  // namespace

std::vector<std::vector<bool>> reach(const ir::Graph& graph, NodeId root, std::uint64_t position,
                                     std::uint64_t last) {
    const std::uint64_t length = last + 1;
    std::vector<Ranges> ranges(root + std::size_t{1}, Ranges(length));
    std::vector<std::vector<bool>> result(root + std::size_t{1});
    ranges[root].add(position, position + 1);
    for (NodeId id = root + 1; id-- > 0;) {
        result[id] = ranges[id].positions();
        const ir::Node& node = graph[id];
        for (std::uint64_t k = 0; k < length && !node.operands.empty(); ++k) {
            if (!result[id][k]) continue;
            if (!is_temporal(node)) {
                for (const NodeId operand : node.operands) ranges[operand].add(k, k + 1);
                continue;
            }
            const bool past = is_past(node);
            const std::uint64_t room = past ? k : last - k;
            if (node.interval.low > room) continue;
            const std::uint64_t high = std::min<std::uint64_t>(node.interval.high, room);
            const NodeId operand = node.operands.back();
            if (past)
                ranges[operand].add(k - high, k - node.interval.low + 1);
            else
                ranges[operand].add(k + node.interval.low, k + high + 1);
            if (node.operands.size() == 1) continue;
            if (past)
                ranges[node.operands.front()].add(k - high + 1, k + 1);
            else
                ranges[node.operands.front()].add(k, k + high);
        }
    }
    return result;
}

Claim::Claim(const ir::Graph& graph, NodeId root, std::uint64_t position, std::uint64_t last,
             bool satisfied, const std::vector<std::vector<bool>>& speaks_for_it)
    : graph_(graph),
      root_(root),
      position_(position),
      last_(last),
      satisfied_(satisfied),
      true_(reach(graph, root, position, last)),
      offsets_(root + std::size_t{1}),
      parents_(root + std::size_t{1}),
      first_(root + std::size_t{1}, kNever),
      final_(root + std::size_t{1}, 0) {
    for (NodeId id = 0; id <= root; ++id) {
        const ir::Node& node = graph[id];
        for (std::uint64_t k = 0; k <= last; ++k) {
            if (!true_[id][k]) continue;
            first_[id] = std::min(first_[id], k);
            final_[id] = k;
        }
        if (first_[id] == kNever) continue;
        for (std::size_t n = 0; n < node.operands.size(); ++n)
            parents_[node.operands[n]].push_back({id, n + 1 == node.operands.size()});
        if (node.operands.empty()) {
            for (std::uint64_t k = first_[id]; k <= final_[id]; ++k)
                true_[id][k] = true_[id][k] && speaks_for_it[id][k];
            continue;
        }
        establish(id);
    }
}

/// Of a max, a claim that it is satisfied asks for one operand, that it is violated for all; of a
/// min the other way round.
bool Claim::asks_for_one(const ir::Node& node) const {
    return (ir::takes_max(node.op) || node.op == ir::Op::disjunction) == satisfied_;
}

Claim::Window Claim::window(const ir::Node& node, std::uint64_t position) const {
    const std::uint64_t room = is_past(node) ? position : last_ - position;
    return {node.interval.low, std::min<std::uint64_t>(node.interval.high, room),
            node.interval.low > room};
}

// ---- what is true to begin with -----------------------------------------------------------------

void Claim::establish(NodeId id) {
    const ir::Node& node = graph_[id];
    if (is_temporal(node)) offsets_[id].resize(last_ + 1);
    for (std::uint64_t k = first_[id]; k <= final_[id]; ++k)
        if (true_[id][k])
            true_[id][k] = is_temporal(node) ? search(id, k, 0) : combination(node, k);
}

bool Claim::combination(const ir::Node& node, std::uint64_t position) const {
    const bool one = asks_for_one(node);
    for (const NodeId operand : node.operands)
        if (true_[operand][position] == one) return one;
    return !one;
}

bool Claim::search(NodeId id, std::uint64_t position, std::uint64_t from) {
    return asks_for_one(graph_[id]) ? find_witness(id, position, from)
                                    : find_release(id, position, from);
}

/// The first place of the window, at or after `from`, where the last operand is true, and the left
/// one up to there. Before `from` the left one is.
bool Claim::find_witness(NodeId id, std::uint64_t position, std::uint64_t from) {
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

/// The first place, at or after `from`, where the left operand is true: up to it the last one has
/// to be true in the window. Before `from` it is.
bool Claim::find_release(NodeId id, std::uint64_t position, std::uint64_t from) {
    const ir::Node& node = graph_[id];
    const Window w = window(node, position);
    offsets_[id][position] = kNever;
    if (w.empty) return true;
    const std::vector<bool>& last = true_[node.operands.back()];
    const bool binary = node.operands.size() == 2;
    const std::vector<bool>& left = true_[node.operands.front()];
    for (std::uint64_t o = binary ? from : std::max(from, w.low); o <= w.high; ++o) {
        if (o >= w.low && !last[at(node, position, o)]) return false;
        if (binary && o < w.high && left[at(node, position, o)]) {
            offsets_[id][position] = o;
            return true;
        }
    }
    return true;
}

// ---- without some of it -------------------------------------------------------------------------

bool Claim::needs(const std::vector<Evidence>& evidence) {
    const bool still_true = withdraw(evidence);
    take_back();
    return !still_true;
}

bool Claim::can_do_without(const std::vector<Evidence>& evidence) {
    const bool still_true = withdraw(evidence);
    if (!still_true) take_back();
    changes_.clear();
    return still_true;
}

bool Claim::withdraw(const std::vector<Evidence>& evidence) {
    for (const Evidence& e : evidence) refute(e.literal, e.step);
    while (!refuted_.empty() && holds()) {
        const Evidence next = refuted_.back();
        refuted_.pop_back();
        for (const Parent& parent : parents_[next.literal]) tell(parent, next.step);
    }
    refuted_.clear();
    return holds();
}

void Claim::refute(NodeId id, std::uint64_t position) {
    if (!true_[id][position]) return;
    const std::uint64_t offset = offsets_[id].empty() ? 0 : offsets_[id][position];
    changes_.push_back({id, position, offset});
    true_[id][position] = false;
    refuted_.push_back({id, position});
}

/// The operand is no longer true at this position.
void Claim::tell(const Parent& parent, std::uint64_t position) {
    const ir::Node& node = graph_[parent.node];
    if (!is_temporal(node)) {
        if (true_[parent.node][position] && !combination(node, position))
            refute(parent.node, position);
        return;
    }
    const std::uint64_t room = is_past(node) ? last_ - position : position;
    const std::uint64_t low = parent.is_last ? node.interval.low : 0;
    const std::uint64_t high = std::min<std::uint64_t>(node.interval.high, room);
    if (low > high) return;
    // The positions that see this one at an offset in [low, high] and are within reach.
    std::uint64_t from = is_past(node) ? position + low : position - high;
    std::uint64_t to = is_past(node) ? position + high : position - low;
    from = std::max(from, first_[parent.node]);
    to = std::min(to, final_[parent.node]);
    for (std::uint64_t k = from; k <= to && holds(); ++k)
        if (true_[parent.node][k])
            reconsider(parent, k, is_past(node) ? k - position : position - k);
}

/// The operand is no longer true at this offset from the position.
void Claim::reconsider(const Parent& parent, std::uint64_t position, std::uint64_t offset) {
    const NodeId id = parent.node;
    const std::uint64_t known = offsets_[id][position];
    const bool one = asks_for_one(graph_[id]);
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

void Claim::take_back() {
    for (; !changes_.empty(); changes_.pop_back()) {
        const Before& before = changes_.back();
        true_[before.node][before.position] = true;
        if (!offsets_[before.node].empty()) offsets_[before.node][before.position] = before.offset;
    }
}

}  // namespace etlc::explain
