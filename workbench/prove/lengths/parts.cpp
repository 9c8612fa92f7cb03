#include "prove/lengths/parts.hpp"

#include <utility>

namespace etlc::prove {
namespace {

using reference::Node;
using Kind = Part::Kind;

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

}  // namespace

Parts parts_of(const reference::NormalForm& form) {
    return Builder().take(form);
}

}  // namespace etlc::prove
