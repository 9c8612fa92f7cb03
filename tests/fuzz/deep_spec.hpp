// Deep random specs chosen by bytes: each byte is one choice of the grammar.
// Takes: bytes. Gives: a valid spec of at most about kMostSpecBytes. Keeps true: the same bytes
// give the same spec; a changed byte changes the spec only from there on, which suits libFuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace etlc::fuzz {

inline constexpr std::size_t kMostSpecBytes = 10'000;

std::string deep_spec(const std::uint8_t* bytes, std::size_t size);

}  // namespace etlc::fuzz
