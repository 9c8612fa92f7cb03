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

#include "prove/form.hpp"
#include "prove/image.hpp"
#include "prove/program.hpp"
#include "prove/prove.hpp"
#include "prove/unfolded.hpp"

namespace etlc::prove {

class Repetition {
public:
    /// `why_not`: why there can be none, if that is known.
    Repetition(const plan::Plan& plan, const Definition& definition, std::uint32_t steps,
               std::size_t atoms, Space& space, std::string why_not);

    /// Takes the sample of the next step, for the definition.
    void begin_step();
    /// Compares the definition as a machine with its clauses.
    void check(std::uint32_t monitor, std::uint32_t position, const Numbers& expected);
    /// Some verdict of this step is equal only for the samples that there can be.
    void is_inexact();
    /// Takes the state of the class after the step, and what later comparisons read.
    void end_step(const State& state, const std::vector<Diagram>& compared_later);

    const std::optional<Repeats>& found() const { return found_; }
    /// Returns why nothing was found.
    std::string why_not() const;

private:
    /// A state after a step.
    struct Seen {
        std::uint32_t step = 0;
        std::vector<Diagram> leaves;
        std::vector<std::uint32_t> counters;
    };

    bool is_over() const { return found_ || !why_not_.empty(); }
    void spoil(const char* why);
    void note(const State& state);
    Form form(const State& state, const std::vector<Diagram>& compared_later);
    bool leads_to(const Seen& before, const Seen& now);
    Place first_place(std::uint32_t step) const;

    std::uint32_t steps_;
    Place places_;  ///< of the samples of one step
    Space& space_;
    Unfolded unfolded_;
    Images images_;
    std::uint32_t recent_ = 0;  ///< steps whose samples a form has
    std::string why_not_;
    std::optional<Repeats> found_;
    std::uint32_t step_ = 0;
    std::optional<std::uint32_t> spoilt_;  ///< the last step that no repetition may contain
    const char* why_spoilt_ = "";
    std::vector<std::uint32_t> negated_;  ///< [step] the oldest step in what was negated
    std::map<std::vector<std::uint32_t>, std::vector<Seen>> seen_;  ///< by their form
    std::size_t kept_ = 0;                                          ///< numbers of forms
};

}  // namespace etlc::prove
