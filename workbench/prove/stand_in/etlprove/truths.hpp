// The truth of atoms in diagrams, for etlc and for the programs that it compiles. Takes: an atom at
// a step. Gives: when it is surely true and possibly true, by variables of its own. Keeps true:
// variables may have any values, independent of each other.
#pragma once

#include "diagrams.hpp"

namespace etlprove {

/// The truths that an atom may have at a step: any of three truths, one of the two that are known,
/// or one.
enum class Truths : std::uint32_t { any, known, yes, no };

/// When a truth is surely true, and when it is possibly true.
struct Ends {
    Diagram low, high;
};

/// `sample`: the first place of the sample.
inline Ends ends_of(Diagrams& diagrams, Truths truths, Place sample) {
    if (truths == Truths::yes) return {kAlways, kAlways};
    if (truths == Truths::no) return {kNever, kNever};
    const Diagram high = diagrams.variable(sample + kHigh);
    if (truths == Truths::known) return {high, high};
    return {diagrams.both(high, diagrams.variable(sample + kLow)), high};
}

}  // namespace etlprove
