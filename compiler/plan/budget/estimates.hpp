// What the parts of a plan are estimated to cost.
#pragma once

#include <cstdint>

#include "etlmon/temporal/machine.hpp"

namespace etlc::plan {

inline constexpr std::uint64_t kWord = sizeof(std::uint32_t);
inline constexpr std::uint64_t kKeysPerValue = 2;
/// For a window whose highs and lows differ: finding the blocks with highs of their own
/// (etlmon::Parting).
inline constexpr std::uint64_t kPartingComparisons = 6;
/// The lists of greatest values that a step of a count combines, and their results.
inline constexpr std::uint64_t kListsOnStack = 6;

// Estimated code, measured on x86-64 and Cortex-M4 at -O2 and -Os and rounded up.
inline constexpr std::uint64_t kCodePerValueOperation = 24;
inline constexpr std::uint64_t kCodePerEnd = 16;
inline constexpr std::uint64_t kCodePerReading = 64;
inline constexpr std::uint64_t kCodePerWindow = 240;
inline constexpr std::uint64_t kCodePerRing = 64;
inline constexpr std::uint64_t kCodePerMean = 1200;       // of which all means share the most
inline constexpr std::uint64_t kCodePerAdaptation = 144;  // observe_P() on a Cortex-M4 at -Os
inline constexpr std::uint64_t kCodePerTable = 200;
inline constexpr std::uint64_t kCodePerSamples = 600;
inline constexpr std::uint64_t kTransitionBytes = sizeof(etlmon::Transition);
inline constexpr std::uint64_t kStateBytes = sizeof(std::uint32_t) + sizeof(etlmon::Obligations);

}  // namespace etlc::plan
