// The definition of the verdicts as a machine, whose next state depends on its state and on one
// more sample. Takes: the parts of the formulas. Gives: the verdicts after each step. Keeps true:
// its state is all that later verdicts depend on. The value of a formula at a position is a
// function of the samples so far and of its parts at later positions, each of which is a variable
// until its position comes; a verdict is the state with these variables as the clauses of the
// definition say for positions past the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "plan/plan.hpp"
#include "prove/symbols.hpp"
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

/// The formulas of a class in parts that look one step ahead or back at a time. Every unbounded
/// operator begins at 0: `F[a, inf] f` is `F[a,a] F f`, `f U[a,inf] g` is
/// `G[0,a-1] f && F[a,a] (f U g)`, and O and S likewise. Operands have smaller indices than their
/// part.
struct Parts {
    std::vector<Part> all;
    std::vector<std::size_t> of_node;  ///< of the normal form
};

Parts parts_of(const reference::NormalForm& form);

/// The values of parts at later positions, as variables above those of the samples.
class Later {
public:
    explicit Later(std::size_t parts) : parts_(parts) {}

    struct Variable {
        std::size_t part;
        bool dual;            ///< the operator that looks there takes the min
        std::uint32_t ahead;  ///< at least 1
    };
    Place place(const Variable& of) const {
        return kFirst + static_cast<Place>(((of.ahead - 1) * parts_ + of.part) * 2 + of.dual);
    }
    Variable operator[](Place place) const {
        const Place at = place - kFirst;
        return {at / 2 % parts_, at % 2 != 0, static_cast<std::uint32_t>(at / 2 / parts_ + 1)};
    }
    static bool is(Place place) { return place >= kFirst && place < etlprove::kFirstLeft; }
    /// Whether there are places so far ahead.
    bool reaches(std::uint64_t ahead) const {
        return ahead * parts_ * 2 <= etlprove::kFirstLeft - kFirst;
    }

private:
    static constexpr Place kFirst = 1U << 14U;
    std::size_t parts_;
};

class Unfolded {
public:
    Unfolded(const plan::Plan& plan, const Definition& definition, Space& space);

    /// Whether its variables have places.
    bool fits() const;
    /// The steps after which the beginning of the trace is no longer a special case.
    std::uint32_t reach() const { return reach_; }
    /// The greatest number of steps that bounded operators look back and ahead, together.
    std::uint32_t depth() const { return depth_; }

    /// Takes the sample of the next step.
    void step();
    /// Returns a verdict after the step that was taken last.
    Numbers verdict(std::uint32_t monitor, std::uint32_t position);
    /// Appends all that later verdicts depend on.
    void append_state(std::vector<Diagram>& to) const;

private:
    /// The parts where every missing sample is at its low end, or every one at its high end.
    struct Side {
        std::vector<Diagram> now;                  ///< [part] at this step
        std::vector<std::vector<Diagram>> before;  ///< [part] at this step and those before it
        std::vector<Diagram> known;                ///< [part] the extreme of its operand so far
        std::vector<Diagram> begun;                ///< [monitor] the root at position 0
        std::unordered_map<Diagram, Diagram> moved;
    };
    struct Range {
        Diagram lowest, highest;
    };
    using Substituted = std::unordered_map<Diagram, Diagram>;

    void find_memories();
    void step(Side& side, bool high);
    Diagram value(const Side& side, std::size_t part, bool high) const;
    Diagram ahead(const Side& side, const Part& part) const;
    Diagram behind(const Side& side, const Part& part) const;
    Diagram often(const Side& side, const Part& part) const;
    Diagram literal(const Part& part, bool high) const;
    /// A part at this step or a later one, as an operand of an operator.
    Diagram at(const Side& side, std::size_t part, std::uint32_t ahead, bool dual) const;
    Diagram moved(Side& side, Diagram of);
    const Range& range(std::size_t part);
    Diagram with_ranges(Diagram of, bool upper);
    Diagram cut(Diagram of);
    template <class Find>
    Diagram substituted(Diagram of, Substituted& known, const Find& find);
    Diagram gain(bool dual, Diagram a, Diagram b) const {
        return dual ? space_.diagrams.both(a, b) : space_.diagrams.either(a, b);
    }

    const plan::Plan& plan_;
    const Definition& definition_;
    Space& space_;
    Parts parts_;
    Later later_;
    std::uint32_t reach_ = 0;
    std::uint32_t depth_ = 0;
    std::vector<std::uint32_t> memories_;  ///< [part] steps that are kept
    std::uint32_t steps_ = 0;
    Side low_, high_;
    std::unordered_map<std::size_t, Range> ranges_;  ///< at this step
    Substituted cut_, lower_, upper_;
};

}  // namespace etlc::prove
