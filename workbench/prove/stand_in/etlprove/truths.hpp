// The truth of atoms in diagrams, for etlc and for the programs that it compiles. Takes: an atom at
// a step. Gives: when it is surely true and possibly true, by variables of its own. Keeps true:
// variables may have any values, independent of each other.
#pragma once

#include "diagrams.hpp"

namespace etlprove {

/// The truths that an atom may have at a step: any of three truths, one of the two that are known,
/// or one.
enum class Truths : std::uint32_t { any, known, yes, no };

/// The variables of a step: two for each atom, and for each monitor whether it is restarted before
/// the step. Later steps come first.
struct TruthPlaces {
    std::uint32_t steps, atoms, monitors;

    constexpr Place atom(std::uint32_t step, std::uint32_t atom) const {
        return first(step) + 2 * atom;
    }
    constexpr Place restart(std::uint32_t step, std::uint32_t monitor) const {
        return first(step) + 2 * atoms + monitor;
    }
    constexpr std::uint32_t per_step() const { return 2 * atoms + monitors; }

private:
    constexpr Place first(std::uint32_t step) const {
        return kFirstSample + (steps - 1 - step) * per_step();
    }
};

/// When a truth is surely true, and when it is possibly true.
struct Ends {
    Diagram low, high;
};

inline Ends ends_of(Diagrams& diagrams, Truths truths, Place place) {
    if (truths == Truths::yes) return {kAlways, kAlways};
    if (truths == Truths::no) return {kNever, kNever};
    const Diagram high = diagrams.variable(place);
    if (truths == Truths::known) return {high, high};
    return {diagrams.both(high, diagrams.variable(place + 1)), high};
}

}  // namespace etlprove
