// The symbols of a proof: robustness as a function of all samples. Takes: a plan. Gives: its atoms;
// the definition of each verdict, expanded by brute force: the clauses of the reference evaluator
// (reference/clauses.hpp), instantiated for such functions; and an input on which two functions
// differ.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "check/model/model.hpp"
#include "plan/plan.hpp"
#include "prove/stand_in/etlprove/diagrams.hpp"
#include "reference/prefix.hpp"

namespace etlc::prove {

using etlprove::Diagram;
using etlprove::Place;

/// Thrown where the diagrams do not fit into memory.
struct Exhausted {};

/// Thrown where a number is not among those of the proof.
struct NewNumber {
    float number;
};

/// The diagrams of one proof, and its numbers.
struct Space {
    /// `truths`: values are truth values; else they are robustness.
    Space(const std::set<float>& known, bool truths)
        : numbers(diagrams, std::vector<float>(known.begin(), known.end())), are_truths(truths) {}

    /// As a truth value, a number is whether it is at least 0.
    Diagram at_least(float x) const {
        if (are_truths) return x < 0 ? etlprove::kNever : etlprove::kAlways;
        const Diagram found = numbers.at_least(x);
        if (found == etlprove::Numbers::kNoNumber) throw NewNumber{x};
        return found;
    }

    etlprove::Diagrams diagrams{etlprove::kMostNodes, [] { throw Exhausted(); }};
    etlprove::Numbers numbers;
    bool are_truths;
};

/// A function of the samples, of the proof that runs in this thread.
class Symbol {
public:
    Symbol() = default;
    Symbol(double number)  // NOLINT(google-explicit-constructor)
        : of_(space().at_least(static_cast<float>(number))) {}
    static Symbol of(Diagram diagram) {
        Symbol symbol;
        symbol.of_ = diagram;
        return symbol;
    }
    static Symbol variable(Place place) { return of(space().diagrams.variable(place)); }
    static etlprove::Ends ends_of(etlprove::Truths truths, Place sample) {
        return etlprove::ends_of(space().diagrams, truths, sample);
    }
    Diagram diagram() const { return of_; }

    Symbol operator-() const {
        return of(space().are_truths ? space().diagrams.complement(of_)
                                     : space().diagrams.negation(of_));
    }
    friend Symbol min(Symbol a, Symbol b) { return of(space().diagrams.both(a.of_, b.of_)); }
    friend Symbol max(Symbol a, Symbol b) { return of(space().diagrams.either(a.of_, b.of_)); }

    /// Makes a space that of this thread, while it exists.
    class Scope {
    public:
        explicit Scope(Space& space) : before_(current()) { current() = &space; }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;
        ~Scope() { current() = before_; }

    private:
        Space* before_;
    };

private:
    static Space*& current() {
        static thread_local Space* space = nullptr;
        return space;
    }
    static Space& space() { return *current(); }

    Diagram of_ = etlprove::kNever;
};

using check::Index;
using etlprove::Truths;

/// A predicate or a bool input of some formula.
struct Atom {
    bool is_predicate = true;
    Index index = 0;        ///< of the model's predicates or inputs
    bool is_read = true;    ///< by the class, at every step
    bool is_truth = false;  ///< +inf or -inf: of a bool, == or !=
    bool of_two = false;    ///< a predicate with two thresholds, whose ends differ
    /// Range where the sample is missing, and of every value.
    reference::Unseen missing;
    reference::Unseen range;
    float threshold = 0;  ///< of a predicate
};

/// Returns the atoms of a class, in the order of its Atoms, and then those of the formulas that it
/// does not read.
std::vector<Atom> atoms_of(const plan::Plan& plan);
/// Returns the truths that each atom may have in a class of truth values; none of another class.
std::vector<Truths> truths_of(const plan::Plan& plan, const std::vector<Atom>& atoms);

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
    /// `steps`: that have variables. `missing`: every sample may be missing; else none is.
    Definition(const plan::Plan& plan, const std::vector<Atom>& atoms,
               const std::vector<Truths>& truths, std::uint32_t steps, bool missing);

    /// Returns the verdict about a position after step `end`. A sliding verdict is about a position
    /// whose later samples do not count.
    Numbers verdict(std::uint32_t monitor, std::uint32_t end, std::uint32_t position);
    /// Forgets what was computed for the verdicts after a step.
    void forget(std::uint32_t end) { prefixes_[end].reset(); }
    const reference::NormalForm& form() const { return form_; }
    const reference::LiteralsOf<Symbol>& literals() const { return literals_; }

private:
    using Literal = reference::ValueOf<Symbol>;
    static Literal number(Place sample, bool negated, bool missing);
    static Literal truth(Truths truths, Place sample, bool negated);

    const plan::Plan& plan_;
    reference::NormalForm form_;
    reference::LiteralsOf<Symbol> literals_;
    std::vector<std::unique_ptr<reference::PrefixOf<Symbol>>> prefixes_;  ///< by their end
};

/// The robustness of each atom at each step, nothing where its sample is missing, and a threshold
/// that one of the functions reaches and the other does not.
struct Witness {
    std::vector<std::vector<std::optional<float>>> values;  ///< [step][atom]
    float threshold = 0;
    bool first_reaches = false;
};

/// Finds an input of `steps` steps, in a proof of `most_steps`; nothing where the functions are
/// equal on all inputs: where each sample is a number in its range or missing, and the negation of
/// a number is minus that number. `may_be_missing`: some samples may be missing.
std::optional<Witness> difference(Space& space, Diagram first, Diagram second,
                                  const std::vector<Atom>& atoms, std::uint32_t steps,
                                  std::uint32_t most_steps, bool may_be_missing,
                                  bool at_zero = false);

/// Returns an input of `steps` steps on which a condition on truths is true, in a proof of
/// `most_steps`.
Witness truths_where(const etlprove::Diagrams& diagrams, Diagram condition,
                     const std::vector<Atom>& atoms, const std::vector<Truths>& truths,
                     std::uint32_t steps, std::uint32_t most_steps);

/// Whether two functions are equal where every end of a sample, by itself, is in its range.
bool are_equal_in_ranges(Space& space, Diagram first, Diagram second,
                         const std::vector<Atom>& atoms);
/// Returns which ends of a sample can reach a threshold, for every threshold: a bit for each set of
/// ends, [atom], where every end is in its range.
std::set<std::vector<std::uint16_t>> ends_in_ranges(Space& space, const std::vector<Atom>& atoms);

}  // namespace etlc::prove
