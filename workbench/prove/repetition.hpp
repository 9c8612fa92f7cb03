// Proves verdicts of all later steps from those of some: where the state of the class and that of
// the definition come back to a form that was seen, all goes on as it did from there.
// Takes: both states after each step. Gives: two steps with the same form, or why there are none.
// Keeps true: the states at the second step are the same functions as at the first, of the last
// samples and of functions of older ones that take the same values together. So all that follows is
// the same, and verdicts that are equal for all samples between the two steps are equal after them.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "prove/program.hpp"
#include "prove/prove.hpp"
#include "prove/symbols.hpp"
#include "prove/unfolded.hpp"

namespace etlc::prove {

/// The form of a state: what it does with the samples, wherever they are in the trace. Its numbers
/// are equal where the states are the same functions of the last samples, and of functions of older
/// samples in the same places.
class Form {
public:
    /// `first`: the place of the first sample of the step; `older`: that of the older samples.
    Form(const etlprove::Diagrams& diagrams, Place first, Place older)
        : diagrams_(diagrams), first_(first), older_(older) {}

    void add_control(std::uint32_t word) {
        numbers_.push_back(kControl);
        numbers_.push_back(word);
    }
    void add_counter() { numbers_.push_back(kCounter); }
    void add(Diagram diagram) {
        const std::uint32_t number = number_of(diagram);
        numbers_.push_back(kDiagram);
        numbers_.push_back(number);
    }

    const std::vector<std::uint32_t>& numbers() const { return numbers_; }
    /// The functions of older samples, in the order in which they are used first.
    const std::vector<Diagram>& leaves() const { return leaves_; }

private:
    enum Tag : std::uint32_t { kControl, kCounter, kDiagram, kLeaf, kNode };

    /// Returns the number of a diagram, in the order in which they come first.
    std::uint32_t number_of(Diagram diagram) {
        if (diagram <= etlprove::kAlways) return diagram;
        if (const auto found = known_.find(diagram); found != known_.end()) return found->second;
        const etlprove::Diagrams::Node node = diagrams_[diagram];
        if (node.place >= older_) {
            leaves_.push_back(diagram);
            numbers_.push_back(kLeaf);
        } else {
            const std::uint32_t without = number_of(node.without), with = number_of(node.with);
            const bool is_sample = node.place >= etlprove::kFirstSample;
            numbers_.push_back(kNode);
            numbers_.push_back(is_sample ? node.place - first_ + etlprove::kFirstSample
                                         : node.place);
            numbers_.push_back(without);
            numbers_.push_back(with);
        }
        const std::uint32_t number = static_cast<std::uint32_t>(known_.size()) + 2;
        known_.emplace(diagram, number);
        return number;
    }

    const etlprove::Diagrams& diagrams_;
    Place first_, older_;
    std::vector<std::uint32_t> numbers_;
    std::vector<Diagram> leaves_;
    std::unordered_map<Diagram, std::uint32_t> known_;
};

/// Compares the values that two lists of functions take together, over all samples.
class Images {
public:
    using Functions = std::vector<Diagram>;
    /// Per atom, a bit for each set of ends of a sample that can be true, each end by itself.
    using Possible = std::vector<std::uint16_t>;

    Images(etlprove::Diagrams& diagrams, std::size_t atoms) : diagrams_(diagrams), atoms_(atoms) {}

    /// `possible`: of the samples; null: every end may be anything. False where there are too many
    /// values to find out.
    bool are_equal(const Functions& first, const Functions& second, const Possible* possible);
    /// Whether it is no use to ask for more.
    bool gives_up() const { return failures_ >= kMostFailures; }

private:
    using Cache = std::unordered_map<Diagram, Diagram>;
    using Support = std::bitset<512>;

    static constexpr std::uint32_t kMostBranches = 20000;
    static constexpr std::uint32_t kMostDiagrams = 1U << 19U;
    static constexpr int kMostFailures = 2;

    const Support& support(Diagram of);
    std::vector<std::vector<std::size_t>> groups(const Functions& first, const Functions& second);
    Diagram in_ranges(Diagram of, const Possible& possible, Cache& cache);
    bool may_be(const Possible& possible, Place place, bool is_true) const;
    bool agree(std::size_t n, Diagram one, Diagram other);

    etlprove::Diagrams& diagrams_;
    std::size_t atoms_;
    int failures_ = 0;
    std::unordered_map<Diagram, Support> supports_;
    // The two lists that are compared, what was compared, and the limit for it.
    Functions first_, second_;
    std::set<std::tuple<std::size_t, Diagram, Diagram>> agreed_;
    std::uint32_t most_diagrams_ = 0;
    bool is_too_large_ = false;
};

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
    void give_up(const std::string& why) {
        if (why_not_.empty()) why_not_ = why;
    }
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

    std::uint32_t places_;
    const std::vector<Atom>& atoms_;
    Space& space_;
    Unfolded unfolded_;
    Images images_;
    std::vector<Forms> forms_;
    std::string why_not_;
    std::optional<Repeats> found_;
    std::uint32_t step_ = 0;
    std::vector<std::vector<std::uint32_t>> counted_;      ///< [step] of each counter
    bool is_counting_ = false;                             ///< one has not reached its constant
    std::optional<std::uint32_t> inexact_, needs_ranges_;  ///< the last such steps
    std::vector<std::uint32_t> negated_;  ///< [step] the oldest step in what was negated
    std::vector<std::vector<std::uint32_t>> controls_;  ///< [step] control words
    std::size_t kept_ = 0;                              ///< numbers in all forms
};

}  // namespace etlc::prove
