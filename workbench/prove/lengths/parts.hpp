// The formulas of a class in parts that look one step ahead or back at a time.
// Takes: a normal form. Gives: the same formulas, where every unbounded operator begins at 0: `F[a,
// inf] f` is `F[a,a] F f`, `f U[a,inf] g` is `G[0,a-1] f && F[a,a] (f U g)`, and O and S likewise.
// Keeps true: operands have smaller indices than their part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "reference/normal_form.hpp"

namespace etlc::prove {

struct Part {
    enum class Kind : std::uint8_t {
        constant,
        literal,
        any,     ///< || of the operands; its dual is &&
        ahead,   ///< F[low, high]
        until,   ///< f U[low, high] g
        later,   ///< F g, or f U g
        once,    ///< O[low, high]
        since,   ///< f S[low, high] g
        so_far,  ///< O g, or f S g
        often,   ///< at `count` or more of the last positions [0, high]
    };
    Kind kind = Kind::constant;
    bool dual = false;
    std::vector<std::size_t> operands;  ///< f before g
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t count = 0;
    check::Index node = 0;  ///< of a literal

    /// How the range of its values at later positions follows from that of its last operand, or
    /// from that of another part.
    std::optional<std::size_t> ranges_as;
    bool may_be_empty = false;   ///< it may have no position
    bool looks_back = false;     ///< it also has what is known of the operand
    bool never_forgets = false;  ///< at both ends
};

struct Parts {
    std::vector<Part> all;
    std::vector<std::size_t> of_node;  ///< of the normal form
};

Parts parts_of(const reference::NormalForm& form);

}  // namespace etlc::prove
