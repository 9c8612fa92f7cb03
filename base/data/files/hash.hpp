// XXH64, the 64-bit hash of the xxHash family by Yann Collet, from its public specification
// (doc/xxhash_spec.md, 0.1.1). Takes: bytes and a seed. Gives: the same 64 bits on every machine.
// Keeps true: it distinguishes data that differ by accident; it is no defence against data made
// to collide.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "diag/diag.hpp"

namespace etlc::data {

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed = 0);

/// Writes a hash as 16 hex digits, lower case.
std::string hash_text(std::uint64_t hash);
/// Reads what hash_text() writes.
std::optional<std::uint64_t> hash_of_text(std::string_view text);

/// Hashes a file of any size, as 16 hex digits. Failures carry the code and do not repeat the path.
diag::Result<std::string> hash_of_file(const std::string& path, diag::Code code);

/// Returns what usually identifies a large file: its size, and its first and last 4 KiB. Empty
/// where it cannot be read.
std::string ends_of_file(const std::string& path);

}  // namespace etlc::data
