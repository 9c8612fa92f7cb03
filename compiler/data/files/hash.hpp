// XXH64, the 64-bit hash of the xxHash family by Yann Collet, from its public specification
// (doc/xxhash_spec.md, 0.1.1). Takes: bytes and a seed. Gives: the same 64 bits on every machine.
// Keeps true: it tells data apart that differ by accident; it is no defence against data made to
// collide.
#pragma once

#include <cstdint>
#include <string_view>

namespace etlc::data {

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed = 0);

}  // namespace etlc::data
