// The definition of each verdict, expanded by brute force over symbols: the clauses of the
// reference evaluator (reference/clauses.hpp), instantiated for functions of all samples.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "check/model/model.hpp"
#include "plan/plan.hpp"
#include "prove/symbols/symbol.hpp"
#include "reference/prefix.hpp"

namespace etlc::prove {

using check::Index;

/// A predicate or a bool input of some formula.
struct Atom {
    bool is_predicate = true;
    Index index = 0;        ///< of the model's predicates or inputs
    bool is_read = true;    ///< by the class, at every step
    bool is_truth = false;  ///< +inf or -inf: of a bool, == or !=
    /// Range where the sample is missing, and of every value.
    reference::Unseen missing;
    reference::Unseen range;
};

/// Returns the atoms of a class, in the order of its Atoms, and then those of the formulas that it
/// does not read.
std::vector<Atom> atoms_of(const plan::Plan& plan);

/// The diagrams of a verdict.
struct Numbers {
    bool decided = false;
    Diagram low = 0;   ///< rho, where missing samples are as bad as possible
    Diagram high = 0;  ///< and as good as possible
    Diagram lower = 0;
    Diagram upper = 0;

    bool operator==(const Numbers&) const = default;
};

class Definition {
public:
    /// `missing`: every sample may be missing; else none is.
    Definition(const plan::Plan& plan, const std::vector<Atom>& atoms, std::uint32_t steps,
               bool missing);

    /// Returns the verdict about a position after step `end`. A sliding verdict is about a position
    /// whose later samples do not count.
    Numbers verdict(std::uint32_t monitor, std::uint32_t end, std::uint32_t position);
    /// Forgets what was computed for the verdicts after a step.
    void forget(std::uint32_t end) { prefixes_[end].reset(); }
    const reference::NormalForm& form() const { return form_; }
    const reference::LiteralsOf<Symbol>& literals() const { return literals_; }

private:
    using Literal = reference::ValueOf<Symbol>;

    const plan::Plan& plan_;
    reference::NormalForm form_;
    reference::LiteralsOf<Symbol> literals_;
    std::vector<std::unique_ptr<reference::PrefixOf<Symbol>>> prefixes_;  ///< by their end
};

}  // namespace etlc::prove
