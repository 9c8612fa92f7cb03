#include "prove/unfolded.hpp"

#include <algorithm>

namespace etlc::prove {

namespace {

using reference::Node;
using Kind = Part::Kind;
using etlprove::kAlways;
using etlprove::kNever;

class Builder {
public:
    Parts take(const reference::NormalForm& form) {
        for (check::Index n = 0; n < form.nodes.size(); ++n)
            parts_.of_node.push_back(build(form.nodes[n], n));
        return std::move(parts_);
    }

private:
    std::size_t add(Part part) {
        parts_.all.push_back(std::move(part));
        return parts_.all.size() - 1;
    }

    /// Adds the part of a node; its range is that of the node.
    std::size_t build(const Node& node, check::Index index) {
        Part part;
        part.dual = node.negated;
        part.node = index;
        if (node.is_atom()) part.kind = Kind::literal;
        if (node.is_atom() || node.kind == Node::Kind::constant) return add(part);
        for (const check::Index operand : node.operands)
            part.operands.push_back(parts_.of_node[operand]);
        part.low = node.low;
        part.high = node.high;
        part.count = node.index;
        const bool counts = node.kind == Node::Kind::at_least;
        part.looks_back = counts || node.kind == Node::Kind::once || node.kind == Node::Kind::since;
        const bool unbounded = node.high == check::kUnbounded;
        part.may_be_empty = node.low > 0 || counts;
        part.never_forgets = node.kind == Node::Kind::once && node.low == 0 && unbounded;
        switch (node.kind) {
            case Node::Kind::any: part.kind = Kind::any; return add(part);
            case Node::Kind::eventually: part.kind = unbounded ? Kind::later : Kind::ahead; break;
            case Node::Kind::until: part.kind = unbounded ? Kind::later : Kind::until; break;
            case Node::Kind::once: part.kind = unbounded ? Kind::so_far : Kind::once; break;
            case Node::Kind::since: part.kind = unbounded ? Kind::so_far : Kind::since; break;
            default: part.kind = Kind::often; break;
        }
        return unbounded && node.low > 0 ? add_late(part) : add(part);
    }

    /// An unbounded operator that begins at low > 0.
    std::size_t add_late(const Part& part) {
        const bool is_past = part.kind == Kind::so_far;
        const Kind window = is_past ? Kind::once : Kind::ahead;
        Part from_zero = part;
        from_zero.low = 0;
        from_zero.may_be_empty = false;
        Part begins = part;
        begins.kind = window;
        begins.high = part.low;
        begins.operands = {add(from_zero)};
        if (part.operands.size() == 1) return add(begins);
        Part holds;
        holds.kind = window;
        holds.dual = !part.dual;
        holds.high = part.low - 1;
        holds.operands = {part.operands[0]};
        const std::size_t held = add(holds), begun = add(begins);
        Part both;
        both.kind = Kind::any;
        both.dual = !part.dual;
        both.operands = {held, begun};
        both.ranges_as = begun;
        return add(both);
    }

    Parts parts_;
};

/// The value of an operator that has no position.
Diagram nothing(bool dual) {
    return dual ? kAlways : kNever;
}

bool is_bounded(Kind kind) {
    return kind == Kind::ahead || kind == Kind::until || kind == Kind::once ||
           kind == Kind::since || kind == Kind::often;
}

bool is_past(Kind kind) {
    return kind == Kind::once || kind == Kind::since || kind == Kind::often;
}

}  // namespace

Parts parts_of(const reference::NormalForm& form) {
    return Builder().take(form);
}

Unfolded::Unfolded(const plan::Plan& plan, const Definition& definition, Space& space)
    : plan_(plan),
      definition_(definition),
      space_(space),
      parts_(parts_of(definition.form())),
      later_(parts_.all.size()),
      memories_(parts_.all.size(), 0) {
    find_memories();
    for (Side* const side : {&low_, &high_}) {
        side->now.resize(parts_.all.size());
        side->before.resize(parts_.all.size());
        side->begun.resize(plan.monitors.size());
        for (const Part& part : parts_.all) side->known.push_back(nothing(part.dual));
    }
}

void Unfolded::find_memories() {
    std::vector<std::uint32_t> depths;
    for (std::size_t p = 0; p < parts_.all.size(); ++p) {
        const Part& part = parts_.all[p];
        std::uint32_t depth = 0;
        for (const std::size_t operand : part.operands) depth = std::max(depth, depths[operand]);
        depths.push_back(depth + (is_bounded(part.kind) ? part.high : 0));
        depth_ = std::max(depth_, depths.back());
        if (part.kind == Kind::so_far) memories_[p] = 1;
        if (!is_past(part.kind)) continue;
        reach_ = std::max(reach_, part.high);
        for (const std::size_t operand : part.operands)
            memories_[operand] = std::max(memories_[operand], part.high + 1);
    }
    for (const plan::Monitor& monitor : plan_.monitors) {
        std::uint32_t& memory = memories_[parts_.of_node[definition_.form().roots[monitor.index]]];
        if (monitor.sliding) memory = std::max(memory, monitor.horizon + 1);
    }
}

bool Unfolded::fits() const {
    return later_.reaches(std::uint64_t{depth_} + 1);
}

void Unfolded::step() {
    step(low_, false);
    step(high_, true);
    ++steps_;
    ranges_.clear();
    cut_.clear();
    lower_.clear();
    upper_.clear();
}

void Unfolded::step(Side& side, bool high) {
    side.moved.clear();
    for (std::size_t p = 0; p < parts_.all.size(); ++p) {
        const Part& part = parts_.all[p];
        std::vector<Diagram>& before = side.before[p];
        // A past operator does not depend on itself at a later position.
        if (part.kind == Kind::so_far)
            for (Diagram& one : before) one = moved(side, one);
        side.now[p] = value(side, p, high);
        if (part.kind != Kind::so_far)
            for (Diagram& one : before) one = moved(side, one);
        before.insert(before.begin(), side.now[p]);
        if (before.size() > memories_[p]) before.pop_back();
        if (part.looks_back)
            side.known[p] =
                gain(part.dual, moved(side, side.known[p]), side.now[part.operands.back()]);
    }
    for (std::size_t m = 0; m < plan_.monitors.size(); ++m) {
        const std::size_t root = parts_.of_node[definition_.form().roots[plan_.monitors[m].index]];
        side.begun[m] = steps_ == 0 ? side.now[root] : moved(side, side.begun[m]);
    }
}

Diagram Unfolded::value(const Side& side, std::size_t p, bool high) const {
    const Part& part = parts_.all[p];
    Diagram result = nothing(part.dual);
    switch (part.kind) {
        case Kind::constant: return part.dual ? kNever : kAlways;
        case Kind::literal: return literal(part, high);
        case Kind::any:
            for (const std::size_t operand : part.operands)
                result = gain(part.dual, result, side.now[operand]);
            return result;
        case Kind::later:
        case Kind::so_far: {
            if (part.kind == Kind::later)
                result = at(side, p, 1, part.dual);
            else if (!side.before[p].empty())
                result = side.before[p][0];
            if (part.operands.size() > 1)
                result = gain(!part.dual, result, side.now[part.operands[0]]);
            return gain(part.dual, result, side.now[part.operands.back()]);
        }
        case Kind::ahead:
        case Kind::until: return ahead(side, part);
        case Kind::once:
        case Kind::since: return behind(side, part);
        case Kind::often: return often(side, part);
    }
    return result;
}

Diagram Unfolded::literal(const Part& part, bool high) const {
    const auto& values = definition_.literals().values[part.node][steps_];
    return (high ? values.rho_high : values.rho).diagram();
}

Diagram Unfolded::at(const Side& side, std::size_t part, std::uint32_t ahead, bool dual) const {
    return ahead == 0 ? side.now[part]
                      : space_.diagrams.variable(later_.place({part, dual, ahead}));
}

Diagram Unfolded::ahead(const Side& side, const Part& part) const {
    Diagram result = nothing(part.dual);
    const bool is_until = part.operands.size() > 1;
    for (std::uint32_t j = part.high + 1; j-- > (is_until ? 0 : part.low);) {
        if (is_until) result = gain(!part.dual, result, at(side, part.operands[0], j, !part.dual));
        if (j >= part.low)
            result = gain(part.dual, result, at(side, part.operands.back(), j, part.dual));
    }
    return result;
}

Diagram Unfolded::behind(const Side& side, const Part& part) const {
    Diagram result = nothing(part.dual), held = nothing(!part.dual);
    const auto back = [&](std::size_t operand, std::uint32_t steps) {
        return side.before[operand][steps];
    };
    for (std::uint32_t j = 0; j <= std::min(part.high, steps_); ++j) {
        if (j >= part.low)
            result = gain(part.dual, result, gain(!part.dual, held, back(part.operands.back(), j)));
        if (part.operands.size() > 1) held = gain(!part.dual, held, back(part.operands[0], j));
    }
    return result;
}

/// The m-th greatest of one more value is the greater of itself and the lesser of that value and
/// the one before it.
Diagram Unfolded::often(const Side& side, const Part& part) const {
    std::vector<Diagram> nth(part.count + 1, nothing(part.dual));
    nth[0] = nothing(!part.dual);
    for (std::uint32_t j = 0; j <= std::min(part.high, steps_); ++j)
        for (std::uint32_t m = part.count; m > 0; --m)
            nth[m] = gain(part.dual, nth[m],
                          gain(!part.dual, nth[m - 1], side.before[part.operands[0]][j]));
    return nth[part.count];
}

/// `find`: what a place becomes. The function is greater where a later part is.
template <class Find>
Diagram Unfolded::substituted(Diagram of, Substituted& known, const Find& find) {
    if (of <= kAlways || !Later::is(space_.diagrams[of].place)) return of;
    if (const auto found = known.find(of); found != known.end()) return found->second;
    const etlprove::Diagrams::Node node = space_.diagrams[of];
    const Diagram without = substituted(node.without, known, find);
    const Diagram with = substituted(node.with, known, find);
    const Diagram result = find(node.place, without, with);
    known.emplace(of, result);
    return result;
}

/// One step later.
Diagram Unfolded::moved(Side& side, Diagram of) {
    return substituted(of, side.moved, [&](Place place, Diagram without, Diagram with) {
        Later::Variable variable = later_[place];
        if (--variable.ahead > 0)
            return space_.diagrams.choose(later_.place(variable), without, with);
        return space_.diagrams.either(without, space_.diagrams.both(side.now[variable.part], with));
    });
}

/// A window that is cut at the end of the trace.
Diagram Unfolded::cut(Diagram of) {
    return substituted(of, cut_, [&](Place place, Diagram without, Diagram with) {
        return later_[place].dual ? with : without;
    });
}

/// Where a window reaches past the end: only one bound of an operator counts what is not seen.
Diagram Unfolded::with_ranges(Diagram of, bool upper) {
    return substituted(of, upper ? upper_ : lower_,
                       [&](Place place, Diagram without, Diagram with) {
                           const Later::Variable variable = later_[place];
                           if (variable.dual == upper) return upper ? with : without;
                           const Range& unseen = range(variable.part);
                           const Diagram end = upper ? unseen.highest : unseen.lowest;
                           return space_.diagrams.either(without, space_.diagrams.both(end, with));
                       });
}

const Unfolded::Range& Unfolded::range(std::size_t p) {
    if (const auto found = ranges_.find(p); found != ranges_.end()) return found->second;
    const Part& part = parts_.all[p];
    const Diagram none = nothing(part.dual);
    Range result{none, none};
    if (part.ranges_as) {
        result = range(*part.ranges_as);
    } else if (part.kind == Kind::constant) {
        result.lowest = result.highest = part.dual ? kNever : kAlways;
    } else if (part.kind == Kind::literal) {
        const auto& ends = definition_.literals().ranges[part.node];
        result = {ends.lowest.diagram(), ends.highest.diagram()};
    } else if (part.kind == Kind::any) {
        for (const std::size_t operand : part.operands) {
            const Range one = range(operand);
            result = {gain(part.dual, result.lowest, one.lowest),
                      gain(part.dual, result.highest, one.highest)};
        }
    } else {
        result = range(part.operands.back());
        if (part.may_be_empty) (part.dual ? result.highest : result.lowest) = none;
        if (part.looks_back && (!part.dual || part.never_forgets))
            result.highest = gain(part.dual, result.highest, with_ranges(high_.known[p], true));
        if (part.looks_back && (part.dual || part.never_forgets))
            result.lowest = gain(part.dual, result.lowest, with_ranges(low_.known[p], false));
    }
    return ranges_.emplace(p, result).first->second;
}

Numbers Unfolded::verdict(std::uint32_t m, std::uint32_t position) {
    const plan::Monitor& monitor = plan_.monitors[m];
    const std::size_t root = parts_.of_node[definition_.form().roots[monitor.index]];
    const auto of = [&](const Side& side) {
        return monitor.sliding ? side.before[root][steps_ - 1 - position] : side.begun[m];
    };
    const Diagram low = cut(of(low_)), high = cut(of(high_));
    if (monitor.sliding) return {true, low, high, low, high};
    return {true, low, high, with_ranges(low_.begun[m], false), with_ranges(high_.begun[m], true)};
}

void Unfolded::append_state(std::vector<Diagram>& to) const {
    for (const Side* const side : {&low_, &high_}) {
        for (const std::vector<Diagram>& before : side->before)
            to.insert(to.end(), before.begin(), before.end());
        to.insert(to.end(), side->known.begin(), side->known.end());
        to.insert(to.end(), side->begun.begin(), side->begun.end());
    }
}

}  // namespace etlc::prove
