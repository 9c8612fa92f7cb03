// What target sets and weights take in memory.
// Takes: a plan and some of its distances. Gives: bytes, as the runtime lays the sets out
// (etlmon/layout.hpp) on a machine of either kind. Keeps true: what an object holds, to the byte
// (tests/firmware/budget_test.sh); sets in the file of targets count as they lie there.
#pragma once

#include <set>

#include "plan/program/program.hpp"

namespace etlc::plan {

/// Whether a machine has vectors of floats: x86-64 and 64-bit Arm do, microcontrollers do not.
enum class Vectors : bool { without, with };

std::uint64_t target_bytes(const Plan& plan, const std::set<Index>& distances, Vectors vectors);

}  // namespace etlc::plan
