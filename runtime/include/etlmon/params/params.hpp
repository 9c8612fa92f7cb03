// SPDX-License-Identifier: MIT
// The parameters of a retargetable class: the numbers of its spec (target sets, thresholds,
// projections, weights) in one block of bytes, NAME.params.bin, in flash or in memory. Takes: bytes
// at a multiple of 64, which must not change while a monitor uses them. Gives: Params, which checks
// whether a class may use them, and if not, why. Keeps true: numbers are returned only if every
// byte is as etlc wrote it, for a class of this shape and encoder, and every number is valid for
// the kernels; the Params of each class has a separate type.
#pragma once

#include "etlmon/checksum.hpp"
#include "etlmon/views.hpp"
#include "etlmon/with_pointer.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The state of a block of parameters.
enum class ParamsState : uint8_t {
  ready,
  absent,          ///< no bytes
  misaligned,      ///< they do not begin at a multiple of 64 bytes
  not_params,      ///< not the head of parameters, or too short
  wrong_version,   ///< a format that this runtime does not read
  wrong_shape,     ///< for a class of another shape: other formulas, inputs, rows or elements
  wrong_size,      ///< another size than that of the class
  wrong_encoder,   ///< made with another encoder than the class
  wrong_checksum,  ///< damaged
  bad_number       ///< a number violates its rule
};

inline const char* words(ParamsState state) noexcept {
  switch (state) {
    case ParamsState::ready:
      return "ready";
    case ParamsState::absent:
      return "there are no parameters";
    case ParamsState::misaligned:
      return "the parameters do not begin at a multiple of 64 bytes";
    case ParamsState::not_params:
      return "the bytes are no parameters";
    case ParamsState::wrong_version:
      return "the parameters have another format than this runtime reads";
    case ParamsState::wrong_shape:
      return "the parameters are for another class: other formulas, inputs, rows or elements";
    case ParamsState::wrong_size:
      return "the parameters have another size than the class takes";
    case ParamsState::wrong_encoder:
      return "the parameters were made with another encoder than the class";
    case ParamsState::wrong_checksum:
      return "the parameters are damaged";
    case ParamsState::bad_number:
      break;
  }
  return "a number among the parameters cannot be what it stands for";
}

/// The state of a monitor when its parameters are replaced.
enum class Past : uint8_t {
  kept,      ///< verdicts go on; measured steps keep their values
  forgotten  ///< a new episode
};

/// XXH64 of what parameters were made from; log them with the verdicts. 0 without parameters.
struct MadeFrom {
  uint64_t spec = 0;        ///< file of the spec, and constants set by --set
  uint64_t data = 0;        ///< target sets, projections, weights
  uint64_t thresholds = 0;  ///< of named predicates
};

/// A contiguous part of the parameters.
struct ParamsPart {
  /// The rule for each number, which is also finite unless it is one of two thresholds.
  enum Rule : uint8_t {
    any,           ///< no other rule
    not_negative,  ///< a threshold on a distance
    positive,      ///< the diagonal of a metric
    unit_rows,     ///< rows of length 1, up to rounding
    symmetric,     ///< a square matrix with a positive diagonal: a metric
    ascending      ///< two thresholds, not both of them infinite
  };
  uint32_t begin;  ///< in floats from the first byte
  uint32_t count;
  uint32_t width;  ///< of a row
  Rule rule;
};

namespace detail {

/// The first 64 bytes. All numbers are little-endian.
struct ParamsHead {
  uint8_t magic[8];
  uint32_t version;
  uint32_t size;     ///< of the block, a multiple of 64
  uint64_t shape;    ///< of the class
  uint64_t encoder;  ///< XXH64 of a line per encoder, NAME FINGERPRINT; 0: no encoder
  // The hashes of MadeFrom.
  uint64_t spec, data, thresholds;
  uint64_t checksum;  ///< XXH64 of the block, with 0 in this place
};
static_assert(sizeof(ParamsHead) == 64, "as it lies in the file");

constexpr uint8_t kParamsMagic[8] = {0x89, 'E', 'T', 'L', 'P', 'A', 'R', '\n'};
constexpr uint32_t kParamsVersion = 1;
constexpr size_t kParamsAlignment = 64;

inline ParamsHead params_head(const uint8_t* bytes) noexcept {
  ParamsHead head;
  copy_bytes(&head, bytes, sizeof head);
  return head;
}

/// Returns the checksum of `size` bytes, a multiple of 64 and at least 64.
inline uint64_t params_checksum(const uint8_t* bytes, size_t size) noexcept {
  constexpr size_t kHalf = sizeof(ParamsHead) / 2;
  uint8_t half[kHalf];
  copy_bytes(half, bytes + kHalf, kHalf);
  for (size_t i = kHalf - sizeof(uint64_t); i < kHalf; ++i) half[i] = 0;
  Checksum checksum;
  checksum.add(bytes, kHalf);
  checksum.add(half, kHalf);
  checksum.add(bytes + 2 * kHalf, size - 2 * kHalf);
  return checksum.value();
}

/// Returns whether a row has length 1, up to a few roundings of its sum of squares.
inline bool has_unit_length(const float* row, uint32_t width) noexcept {
  constexpr float kRoundings = 1.0f / 256;
  float sum = 0.0f;
  for (uint32_t i = 0; i < width; ++i) sum += row[i] * row[i];
  return is_finite(sum) && sum > 1.0f - kRoundings && sum < 1.0f + kRoundings;
}

inline bool is_symmetric(const float* matrix, uint32_t width) noexcept {
  for (size_t i = 0; i < width; ++i) {
    if (!(matrix[i * width + i] > 0.0f)) return false;
    for (size_t j = 0; j < i; ++j) {
      if (observe(matrix[i * width + j]) != observe(matrix[j * width + i])) return false;
    }
  }
  return true;
}

inline bool is_sound(const float* numbers, const ParamsPart& part) noexcept {
  const float* first = numbers + part.begin;
  if (part.rule == ParamsPart::ascending) {
    if (is_nan(first[0]) || is_nan(first[1])) return false;
    return ordered(observe(first[0])) <= ordered(observe(first[1])) &&
           (is_finite(first[0]) || is_finite(first[1]));
  }
  for (uint32_t i = 0; i < part.count; ++i) {
    if (!is_finite(first[i])) return false;
    if (part.rule == ParamsPart::not_negative && first[i] < 0.0f) return false;
    if (part.rule == ParamsPart::positive && !(first[i] > 0.0f)) return false;
  }
  if (part.rule == ParamsPart::symmetric) return is_symmetric(first, part.width);
  if (part.rule != ParamsPart::unit_rows) return true;
  for (uint32_t i = 0; i < part.count; i += part.width) {
    if (!has_unit_length(first + i, part.width)) return false;
  }
  return true;
}

}  // namespace detail

/// Returns the hashes of the parameters that Params::numbers() returned.
inline MadeFrom made_from(const float* numbers) noexcept {
  if (numbers == nullptr) return {};
  const detail::ParamsHead head = detail::params_head(reinterpret_cast<const uint8_t*>(numbers));
  return {head.spec, head.data, head.thresholds};
}

/// A view of a block for the class with this layout: kShape, kEncoder, kSize and kParts. The bytes
/// must outlive the monitors that use them.
template <class Layout>
class Params {
 public:
  static constexpr size_t kSize = Layout::kSize;  ///< in bytes, a multiple of 64
  static constexpr size_t kAlignment = detail::kParamsAlignment;

  constexpr Params() noexcept = default;
  /// Reads all bytes once.
  Params(const uint8_t* etlmon_bytes, size_t etlmon_size) noexcept
      : state_(check(etlmon_bytes, etlmon_size)) {
    if (ready()) numbers_ = as_floats(etlmon_bytes);
  }

  constexpr bool ready() const noexcept { return state_ == ParamsState::ready; }
  constexpr ParamsState state() const noexcept { return state_; }
  /// Returns the block as floats, with the offsets of Layout; nullptr if it is not ready.
  constexpr const float* numbers() const noexcept { return numbers_; }

  MadeFrom origin() const noexcept { return made_from(numbers_); }

 private:
  static_assert(kSize % kAlignment == 0 && kSize >= sizeof(detail::ParamsHead),
                "a head, and whole lines");
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
  static_assert(kSize == 0, "the numbers in the file are little-endian, this machine's are not");
#endif

  static const float* as_floats(const uint8_t* bytes) noexcept {
    return reinterpret_cast<const float*>(reinterpret_cast<uintptr_t>(bytes));
  }
  static ParamsState check(const uint8_t* bytes, size_t size) noexcept {
    if (bytes == nullptr) return ParamsState::absent;
    if (reinterpret_cast<uintptr_t>(bytes) % kAlignment != 0) return ParamsState::misaligned;
    if (size < sizeof(detail::ParamsHead)) return ParamsState::not_params;
    const detail::ParamsHead found = detail::params_head(bytes);
    for (size_t i = 0; i < sizeof found.magic; ++i) {
      if (found.magic[i] != detail::kParamsMagic[i]) return ParamsState::not_params;
    }
    if (found.version != detail::kParamsVersion) return ParamsState::wrong_version;
    if (found.shape != Layout::kShape) return ParamsState::wrong_shape;
    if (size != kSize || found.size != kSize) return ParamsState::wrong_size;
    if (found.encoder != Layout::kEncoder) return ParamsState::wrong_encoder;
    if (detail::params_checksum(bytes, size) != found.checksum) return ParamsState::wrong_checksum;
    for (const ParamsPart& part : Layout::kParts) {
      if (!detail::is_sound(as_floats(bytes), part)) return ParamsState::bad_number;
    }
    return ParamsState::ready;
  }

  const float* numbers_ = nullptr;
  ParamsState state_ = ParamsState::absent;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
