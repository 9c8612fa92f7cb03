// XXH64, the 64-bit hash of the xxHash family by Yann Collet, from its public specification
// (doc/xxhash_spec.md, 0.1.1). Takes: bytes and a seed. Gives: the same 64 bits on every machine.
// Keeps true: it tells data apart that differ by accident; it is no defence against data made to
// collide.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "diag/diag.hpp"

namespace etlc::data {

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed = 0);

/// As text: 16 hex digits, lower case.
std::string hash_text(std::uint64_t hash);
/// Nothing where it is no such text.
std::optional<std::uint64_t> hash_of_text(std::string_view text);

/// Of a file of any size, 16 hex digits. Failures carry the code and do not repeat the path.
diag::Result<std::string> hash_of_file(const std::string& path, diag::Code code);

/// What mostly tells a large file from others: its size, and its first and last 4 KiB. Empty where
/// it cannot be read.
std::string ends_of_file(const std::string& path);

}  // namespace etlc::data
