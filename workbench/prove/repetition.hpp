// Proves verdicts of all later steps from those of some: where the state of the class and that of
// the definition come back to a form that was seen, all goes on as it did from there.
// Takes: both states after each step. Gives: two steps with the same form, or why there are none.
// Keeps true: the states at the second step are the same functions as at the first, of the last
// samples and of functions of older ones that take the same values together. So all that follows is
// the same, and verdicts that are equal for all samples between the two steps are equal after them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prove/lengths/form.hpp"
#include "prove/lengths/image.hpp"
#include "prove/lengths/unfolded.hpp"
#include "prove/program.hpp"
#include "prove/prove.hpp"

namespace etlc::prove {

class Repetition {
public:
    /// The proof may say why there are none.
    Repetition(const plan::Plan& plan, const Definition& definition, const Proof& proof,
               Space& space);

    /// Takes the sample of the next step, for the definition.
    void begin_step();
    /// Compares the definition as a machine with its clauses.
    void check(std::uint32_t monitor, std::uint32_t position, const Numbers& expected);
    /// Some verdict of this step is equal only for the samples that there can be, or already for
    /// those whose ends are in their ranges.
    void is_inexact(bool in_ranges);
    /// Takes the state of the class after the step, and what later comparisons read.
    void end_step(const State& state, const std::vector<Diagram>& compared_later);

    const std::optional<Repeats>& found() const { return found_; }
    /// Returns why nothing was found.
    std::string why_not() const;
    /// Returns after how many steps something may be found; 0 if that is not known.
    std::uint32_t steps_needed() const;

private:
    /// A state after a step.
    struct Seen {
        std::uint32_t step = 0;
        std::vector<Diagram> leaves;
        std::vector<std::uint32_t> counters;
    };

    /// The forms for one number of last steps.
    struct Forms {
        std::uint32_t recent;  ///< older samples are in functions
        std::map<std::vector<std::uint32_t>, std::vector<Seen>> seen{};
    };

    bool is_over() const { return found_ || !why_not_.empty(); }
    void note(const State& state);
    void look(Forms& forms, const State& state, const std::vector<Diagram>& diagrams);
    bool leads_to(const Forms& forms, const Seen& before, const Seen& now);
    bool take_equal_values(const Seen& before, const Seen& now);
    std::uint32_t period() const;
    Place first_place(std::uint32_t step) const;

    std::uint32_t steps_;
    const std::vector<Atom>& atoms_;
    Space& space_;
    Unfolded unfolded_;
    Images images_;
    std::vector<Forms> forms_;
    std::string why_not_;
    std::optional<Repeats> found_;
    std::uint32_t step_ = 0;
    std::vector<std::uint32_t> counted_;                   ///< [step] as State has it
    std::optional<std::uint32_t> inexact_, needs_ranges_;  ///< the last such steps
    std::vector<std::uint32_t> negated_;  ///< [step] the oldest step in what was negated
    std::vector<std::vector<std::uint32_t>> controls_;  ///< [step] control words
    std::size_t kept_ = 0;                              ///< numbers in all forms
};

}  // namespace etlc::prove
