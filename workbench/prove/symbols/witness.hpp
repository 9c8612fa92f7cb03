// An input on which two functions of the samples differ.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "prove/symbols/definition.hpp"
#include "prove/symbols/symbol.hpp"

namespace etlc::prove {

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

/// Whether two functions are equal where every end of a sample, by itself, is in its range.
bool are_equal_in_ranges(Space& space, Diagram first, Diagram second,
                         const std::vector<Atom>& atoms);
/// Returns which ends of a sample can reach a threshold, for every threshold: a bit for each set of
/// ends, [atom], where every end is in its range.
std::set<std::vector<std::uint16_t>> ends_in_ranges(Space& space, const std::vector<Atom>& atoms);

}  // namespace etlc::prove
