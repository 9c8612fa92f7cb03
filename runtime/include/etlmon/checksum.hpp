// SPDX-License-Identifier: MIT
// XXH64, the 64-bit hash of the xxHash family by Yann Collet, from its public specification
// (doc/xxhash_spec.md, 0.1.1), for bytes in whole stripes of 32. Takes: bytes at any alignment.
// Gives: 64 bits. Keeps true: the result is the same on every machine. The hash detects accidental
// changes, and does not protect against deliberate collisions.
#pragma once

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

constexpr uint64_t kXxhPrime1 = 0x9E3779B185EBCA87u;
constexpr uint64_t kXxhPrime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr uint64_t kXxhPrime3 = 0x165667B19E3779F9u;
constexpr uint64_t kXxhPrime4 = 0x85EBCA77C2B2AE63u;
constexpr uint64_t kXxhPrime5 = 0x27D4EB2F165667C5u;

constexpr uint64_t rotated(uint64_t x, uint32_t by) noexcept { return x << by | x >> (64 - by); }
constexpr uint64_t xxh_round(uint64_t lane, uint64_t input) noexcept {
  return rotated(lane + input * kXxhPrime2, 31) * kXxhPrime1;
}
constexpr uint64_t xxh_merge(uint64_t hash, uint64_t lane) noexcept {
  return (hash ^ xxh_round(0, lane)) * kXxhPrime1 + kXxhPrime4;
}
constexpr uint64_t xxh_finish(uint64_t hash) noexcept {
  hash = (hash ^ (hash >> 33)) * kXxhPrime2;
  hash = (hash ^ (hash >> 29)) * kXxhPrime3;
  return hash ^ (hash >> 32);
}
ETLMON_INLINE uint64_t little_endian(const uint8_t* bytes) noexcept {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  uint64_t word = 0;
  copy_bytes(&word, bytes, sizeof word);
#else
  uint64_t word = 0;
  for (uint32_t i = 0; i < 8; ++i) word |= static_cast<uint64_t>(bytes[i]) << (8 * i);
#endif
  return word;
}

/// The four lanes, and the hash that they are merged into.
class XxhLanes {
 public:
  constexpr explicit XxhLanes(uint64_t etlmon_seed) noexcept
      : a_(etlmon_seed + kXxhPrime1 + kXxhPrime2),
        b_(etlmon_seed + kXxhPrime2),
        c_(etlmon_seed),
        d_(etlmon_seed - kXxhPrime1) {}
  /// Adds a multiple of 32 bytes.
  void add(const uint8_t* bytes, size_t size) noexcept {
    for (; size >= 32; size -= 32, bytes += 32) {
      a_ = xxh_round(a_, little_endian(bytes));
      b_ = xxh_round(b_, little_endian(bytes + 8));
      c_ = xxh_round(c_, little_endian(bytes + 16));
      d_ = xxh_round(d_, little_endian(bytes + 24));
    }
  }
  constexpr uint64_t merged() const noexcept {
    const uint64_t hash = rotated(a_, 1) + rotated(b_, 7) + rotated(c_, 12) + rotated(d_, 18);
    return xxh_merge(xxh_merge(xxh_merge(xxh_merge(hash, a_), b_), c_), d_);
  }

 private:
  uint64_t a_, b_, c_, d_;
};

}  // namespace detail

/// XXH64 with seed 0, of bytes that are added in multiples of 32.
class Checksum {
 public:
  void add(const uint8_t* bytes, size_t size) noexcept {
    lanes_.add(bytes, size);
    length_ += size;
  }
  uint64_t value() const noexcept {
    return detail::xxh_finish((length_ != 0 ? lanes_.merged() : detail::kXxhPrime5) + length_);
  }

 private:
  detail::XxhLanes lanes_{0};
  uint64_t length_ = 0;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
