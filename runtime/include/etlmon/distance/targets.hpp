// SPDX-License-Identifier: MIT
// Target sets outside the program: the bytes of a file NAME.targets.bin, mapped or linked in.
// Takes: bytes at a multiple of 64, which must not change while a monitor uses them. Gives:
// Targets, which checks that they are those that the monitor was generated with. Keeps true: rows
// are returned only if size and checksum are right; the Targets of each file has a separate type.
#pragma once

#include "etlmon/checksum.hpp"
#include "etlmon/distance/kernel.hpp"
#include "etlmon/with_pointer.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The state of a file of targets.
enum class TargetsState : uint8_t {
  ready,
  absent,         ///< no bytes
  misaligned,     ///< they do not begin at a multiple of 64 bytes
  wrong_size,     ///< another file, or a truncated one
  wrong_checksum  ///< another file of that size, or a damaged one
};

inline const char* words(TargetsState state) noexcept {
  switch (state) {
    case TargetsState::ready:
      return "ready";
    case TargetsState::absent:
      return "there are no targets";
    case TargetsState::misaligned:
      return "the targets do not begin at a multiple of 64 bytes";
    case TargetsState::wrong_size:
      return "the targets have another size than those that the monitor was made with";
    case TargetsState::wrong_checksum:
      break;
  }
  return "the targets are not those that the monitor was made with, or are damaged";
}

/// A view of the bytes of the file with this size and XXH64. They must outlive the monitors that
/// use them.
template <uint64_t Size, uint64_t Xxh64>
class Targets {
 public:
  static constexpr uint64_t kSize = Size;    ///< in bytes, a multiple of 64
  static constexpr uint64_t kXxh64 = Xxh64;  ///< of all bytes

  constexpr Targets() noexcept = default;
  /// Reads all bytes once, for the checksum.
  Targets(const uint8_t* etlmon_bytes, size_t etlmon_size) noexcept
      : state_(check(etlmon_bytes, etlmon_size)) {
    if (ready()) rows_ = reinterpret_cast<const float*>(reinterpret_cast<uintptr_t>(etlmon_bytes));
  }

  constexpr bool ready() const noexcept { return state_ == TargetsState::ready; }
  constexpr TargetsState state() const noexcept { return state_; }
  /// Returns the first row, nullptr if they are not ready.
  constexpr const float* rows() const noexcept { return rows_; }

 private:
  static_assert(Size % 64 == 0, "rows begin at multiples of 64");
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
  static_assert(Size == 0, "the numbers in the file are little-endian, this machine's are not");
#endif

  static TargetsState check(const uint8_t* bytes, size_t size) noexcept {
    if (bytes == nullptr) return TargetsState::absent;
    if (size != Size) return TargetsState::wrong_size;
    if (reinterpret_cast<uintptr_t>(bytes) % 64 != 0) return TargetsState::misaligned;
    Checksum checksum;
    checksum.add(bytes, size);
    return checksum.value() == Xxh64 ? TargetsState::ready : TargetsState::wrong_checksum;
  }

  const float* rows_ = nullptr;
  TargetsState state_ = TargetsState::absent;
};

/// Measures rows that each begin at a multiple of 64 bytes, with the bits of measure().
template <class Metric, class Aggregation, uint32_t Rows, uint32_t Dim>
ETLMON_INLINE Measured measure_stored(const float* z, const float* rows,
                                      const float* weights = nullptr) noexcept {
  return detail::best<Metric, Aggregation, detail::Padded<Rows, Dim>, false>(z, rows, weights, {},
                                                                             {});
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
