// The definition of each verdict with --values boolean, expanded by brute force over the truths of
// all samples.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "prove/stand_in/etlprove/truths.hpp"
#include "prove/symbols/definition.hpp"

namespace etlc::prove {

using etlprove::Truths;

/// A truth as a function of the samples. Its negation is the complement.
class Condition {
public:
    Condition() = default;
    Condition(double number)  // NOLINT(google-explicit-constructor)
        : of_(Symbol::of(number < 0 ? etlprove::kNever : etlprove::kAlways)) {}
    explicit Condition(Diagram diagram) : of_(Symbol::of(diagram)) {}
    Diagram diagram() const { return of_.diagram(); }

    Condition operator-() const { return Condition((!of_).diagram()); }
    friend Condition min(Condition a, Condition b) {
        return Condition(min(a.of_, b.of_).diagram());
    }
    friend Condition max(Condition a, Condition b) {
        return Condition(max(a.of_, b.of_).diagram());
    }

private:
    Symbol of_;
};

/// Returns the truths that each atom may have.
std::vector<Truths> truths_of(const plan::Plan& plan, const std::vector<Atom>& atoms);

/// When a verdict has each bit of its status.
struct Statuses {
    Diagram satisfied = etlprove::kNever;
    Diagram violated = etlprove::kNever;
    Diagram final = etlprove::kNever;
};

class BooleanDefinition {
public:
    BooleanDefinition(const plan::Plan& plan, const std::vector<Atom>& atoms,
                      const std::vector<Truths>& truths, Space& space,
                      const etlprove::TruthPlaces& places);

    /// Returns the verdict about a position after step `end`.
    Statuses verdict(std::uint32_t monitor, std::uint32_t end, std::uint32_t position);
    /// Forgets what was computed for the verdicts after a step.
    void forget(std::uint32_t end) { prefixes_[end].reset(); }

private:
    const plan::Plan& plan_;
    reference::NormalForm form_;
    reference::LiteralsOf<Condition> literals_;
    std::vector<std::unique_ptr<reference::PrefixOf<Condition>>> prefixes_;  ///< by their end
};

}  // namespace etlc::prove
