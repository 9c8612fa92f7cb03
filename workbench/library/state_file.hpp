// The bytes of etlc_save(): a head that says what they are a state of, the numbers, and a checksum.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "library/program.hpp"

namespace etlc::library {

/// The session that a state belongs to.
struct StateOrigin {
    std::uint64_t environments = 0;  ///< 0: no batch
    std::uint64_t history = 0;
};

/// Begins the bytes of a state.
void begin_state(const Program& program, const StateOrigin& origin,
                 std::vector<std::uint8_t>& bytes);
/// Appends the checksum.
void end_state(std::vector<std::uint8_t>& bytes);

/// Checks head and checksum, and takes them away. Returns what is wrong; else an empty text.
std::string open_state(const Program& program, const StateOrigin& origin,
                       std::span<const std::uint8_t>& bytes);

}  // namespace etlc::library
