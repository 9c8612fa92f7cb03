// How the pages of a Parquet file are packed.
// Takes: packed bytes and how many they shall be. Gives: these. Keeps true: what a page claims is
// checked against what its packing says before memory is taken for it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace etlc::data::parquet {

inline constexpr std::uint64_t kMaxPageBytes = 256U << 20U;

/// Throws Refused where the codec is not read.
void check_codec(std::int64_t codec);

/// Throws Refused where the bytes are damaged, or other than `size`.
std::string unpacked(std::int64_t codec, std::string_view packed, std::uint64_t size);

}  // namespace etlc::data::parquet
