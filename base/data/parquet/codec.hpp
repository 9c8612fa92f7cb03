// Decompression of the pages of a Parquet file.
// Keeps true: the size that a page claims is compared with the compressed data before memory is
// allocated for it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace etlc::data::parquet {

inline constexpr std::uint64_t kMaxPageBytes = 256U << 20U;

/// Throws Refused where the codec is not supported.
void check_codec(std::int64_t codec);

/// Decompresses a page. Throws Refused where it is damaged, or does not have `size` bytes.
std::string unpacked(std::int64_t codec, std::string_view packed, std::uint64_t size);

}  // namespace etlc::data::parquet
