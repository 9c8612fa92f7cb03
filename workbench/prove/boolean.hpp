// Proves a class with --values boolean, by cases: its program steps it through every state and
// every truth of the atoms that it asks for.
#pragma once

#include <string>
#include <vector>

#include "prove/boolean_definition.hpp"
#include "prove/prove.hpp"

namespace etlc::prove {

/// Failures say why there is no proof.
diag::Result<Proof> prove_boolean(const plan::Plan& plan, const Request& request);

/// The variables of a proof, for `steps` steps and the calls of finish() after the last.
etlprove::TruthPlaces truth_places(const plan::Plan& plan, const std::vector<Atom>& atoms,
                                   std::uint32_t steps);
/// Returns the calls of finish() that report something.
std::uint32_t finishes_of(const plan::Plan& plan);

/// Returns the main file of the program. `may_freeze`: a final verdict stays, so what else it
/// depended on is forgotten; only where reset() leaves nothing of it. Throws Unreadable.
std::string boolean_main(const plan::Plan& plan, const Request& request,
                         const std::vector<Atom>& atoms, const std::vector<Truths>& truths,
                         std::uint32_t steps, bool may_freeze);

/// Returns the runtime's truth.hpp, in which equal truths are equal bytes. Throws Unreadable.
std::string text_of_truths();

/// Makes an input on which a condition is true: the witness of a fault, and its restarts.
void find_truths(Fault& fault, const etlprove::Diagrams& diagrams, Diagram condition,
                 const plan::Plan& plan, const std::vector<Atom>& atoms,
                 const std::vector<Truths>& truths, const etlprove::TruthPlaces& places);

}  // namespace etlc::prove
