// The definition of the verdicts as a machine, whose next state depends on its state and on one
// more sample. Takes: the parts of the formulas. Gives: the verdicts after each step. Keeps true:
// its state is all that later verdicts depend on. The value of a formula at a position is a
// function of the samples so far and of its parts at later positions, each of which is a variable
// until its position comes; a verdict is the state with these variables as the clauses of the
// definition say for positions past the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "plan/plan.hpp"
#include "prove/lengths/parts.hpp"
#include "prove/symbols/definition.hpp"

namespace etlc::prove {

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
    static bool is(Place place) { return place >= kFirst && place < etlprove::kFirstSample; }
    /// Whether there are places so far ahead.
    bool reaches(std::uint64_t ahead) const {
        return ahead * parts_ * 2 <= etlprove::kFirstSample - kFirst;
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
