// SPDX-License-Identifier: MIT
// Distances to int8 targets in integers: l2, l2sq, cosine and angular, which need no more than z .
// g of every row. Takes: z of D finite floats; rows of int8 with one scale, and of each row the sum
// of squares and the sum. Gives: the distance within bounds. Keeps true: z is rounded to integers
// of 14 bits, and how far that moved it is part of the bounds; from there on all is exact in 32 and
// 64 bits until one rounding, so |z|^2 - 2 z.g + |g|^2 loses nothing, however near z is. What does
// not fit (a z farther than 10^5 times what a target's largest byte is worth, zero under cosine) is
// left to the float32 rows: doubtful(). Machines other than x86-64 widen the rows instead.
#pragma once

#include "etlmon/enclosed.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Whether a set is measured so. Few or short rows do not pay for rounding z; very long ones would
/// leave z few bits.
constexpr bool in_integers(uint32_t K, uint32_t D) noexcept {
  return K >= 8 && D > 64 && D <= 16384;
}

namespace detail {

/// A distance from a z that was moved, at most by that.
struct Approximate {
  Measured measured = kUnmeasured;
  float moved = 0.0f;
};

/// Bytes for z as integers.
constexpr uint32_t bytes_scratch(uint32_t D) noexcept { return 2 * ((D + 63) / 64 * 64); }

constexpr int32_t kZero = 8192;  ///< integers of z lie between -kZero and kZero

/// What integers of z stand for: one of them is worth `unit` = scale / 2^power.
struct Grid {
  int32_t power = 0;
  float factor = 0.0f;  ///< 1 / unit
  float moved = 0.0f;   ///< |z - unit x integers| is at most that
  bool fits = false;
};

/// 2^power, for small ones.
ETLMON_INLINE float two_to(int32_t power) noexcept {
  return from_bits(static_cast<uint32_t>(power + 127) << 23);
}

/// The finest grid for a z of which no element is greater. D products of an integer and a byte, at
/// most 16.7e6 x 128, fit in 32 bits. An element is off by half a unit and the roundings on the way
/// to z / unit, of which there are four (1 / unit, a length, their quotient, the product): 8192
/// units x 4 x 2^-24 = 0.002, and as much again for -ffast-math.
ETLMON_INLINE Grid grid_for(float greatest, float scale, uint32_t dimension) noexcept {
  constexpr int32_t kLeastPower = -10, kGreatestPower = 8;
  constexpr float kLeastScale = 9.1e-13f,
                  kGreatestScale = 1.1e9f;  // 2^-40, 2^30: squares stay clear of both ends
  const float fits = 16.7e6f / static_cast<float>(dimension);
  const float most = fits < 8190.0f ? fits : 8190.0f;
  const float room = rounded(rounded(most * scale) / larger(greatest, rounded(scale * 0.001f)));
  int32_t power = static_cast<int32_t>(observe(room) >> 23) - 127;  // room is at least 2^power
  Grid grid;
  if (power < kLeastPower || scale < kLeastScale || scale > kGreatestScale) return grid;
  if (power > kGreatestPower) power = kGreatestPower;
  grid.power = power;
  grid.factor = rounded(two_to(power) / scale);
  grid.moved = 0.51f * scale * two_to(-power) * square_root(static_cast<float>(dimension));
  grid.fits = true;
  return grid;
}

/// |z - g|^2 as an integer: |z|^2 + |g|^2 - 2 z.g in squares of the smaller of unit and scale.
struct IntegerForm {
  int64_t z_square;
  int64_t g_shift, product_shift;
  float unit_square;

  ETLMON_INLINE IntegerForm(int64_t square, const Grid& grid, float scale) noexcept
      : z_square(grid.power < 0 ? square << (-2 * grid.power) : square),
        g_shift(grid.power < 0 ? 0 : 2 * grid.power),
        product_shift(1 + (grid.power < 0 ? -grid.power : grid.power)) {
    const float unit = scale * two_to(grid.power > 0 ? -grid.power : 0);
    unit_square = unit * unit;
  }
};

#if defined(ETLMON_X86_64)

#define ETLMON_WIDE ETLMON_TARGET ETLMON_INLINE

#if defined(ETLMON_DISPATCH) || ETLMON_X86_64 == 4
#define ETLMON_WIDTH 16
#define ETLMON_BYTE_ROWS 8
#define ETLMON_TARGET __attribute__((target("avx2,fma,avx512f,avx512vl,avx512bw,avx512dq")))
namespace x86_64_v4 {
namespace bytes {
// clang-format off
#include "etlmon/byte_products.inc"
#include "etlmon/bytes.inc"
// clang-format on
}  // namespace bytes
}  // namespace x86_64_v4
#undef ETLMON_TARGET
#if defined(ETLMON_DISPATCH) || defined(__AVX512VNNI__)
#define ETLMON_TARGET \
  __attribute__((target("avx2,fma,avx512f,avx512vl,avx512bw,avx512dq,avx512vnni")))
#define ETLMON_VNNI 1
namespace x86_64_v4 {
namespace vnni {
// clang-format off
#include "etlmon/byte_products.inc"
#include "etlmon/bytes.inc"
// clang-format on
}  // namespace vnni
}  // namespace x86_64_v4
#undef ETLMON_VNNI
#undef ETLMON_TARGET
#endif
#undef ETLMON_WIDTH
#undef ETLMON_BYTE_ROWS
#endif

#if ETLMON_X86_64 == 3 || (ETLMON_X86_64 < 3 && defined(ETLMON_DISPATCH))
#define ETLMON_TARGET __attribute__((target("avx2,fma,f16c")))
#define ETLMON_WIDTH 8
#define ETLMON_BYTE_ROWS 8
namespace x86_64_v3 {
namespace bytes {
// clang-format off
#include "etlmon/byte_products.inc"
#include "etlmon/bytes.inc"
// clang-format on
}  // namespace bytes
}  // namespace x86_64_v3
#undef ETLMON_TARGET
#undef ETLMON_WIDTH
#undef ETLMON_BYTE_ROWS
#endif

#if ETLMON_X86_64 < 3
#define ETLMON_TARGET
#define ETLMON_WIDTH 4
#define ETLMON_BYTE_ROWS 4
namespace baseline {
namespace bytes {
// clang-format off
#include "etlmon/byte_products.inc"
#include "etlmon/bytes.inc"
// clang-format on
}  // namespace bytes
}  // namespace baseline
#undef ETLMON_TARGET
#undef ETLMON_WIDTH
#undef ETLMON_BYTE_ROWS
#endif

#undef ETLMON_WIDE

template <class Metric, class Aggregation, class Size>
struct BytesVersions {
  ETLMON_INLINE static auto choice() noexcept {
#if defined(ETLMON_DISPATCH)
    const uint32_t level = x86_64_level();
    if (level >= 4 && multiplies_bytes()) return x86_64_v4::vnni::run<Metric, Aggregation, Size>;
    if (level >= 4) return x86_64_v4::bytes::run<Metric, Aggregation, Size>;
#if ETLMON_X86_64 < 3
    if (level >= 3) return x86_64_v3::bytes::run<Metric, Aggregation, Size>;
#endif
    return baseline::bytes::run<Metric, Aggregation, Size>;
#elif defined(__AVX512VNNI__) && ETLMON_X86_64 == 4
    return x86_64_v4::vnni::run<Metric, Aggregation, Size>;
#else
    return baseline::bytes::run<Metric, Aggregation, Size>;
#endif
  }
};
template <class Metric, class Aggregation, class Size>
ETLMON_INLINE Approximate best_in_integers(const float* z, ScaledRows targets, const int32_t* sums,
                                           uint8_t* scratch, Size size,
                                           Aggregation aggregation) noexcept {
  using Function =
      Approximate(const float*, ScaledRows, const int32_t*, uint8_t*, Size, Aggregation);
  return Dispatch<BytesVersions<Metric, Aggregation, Size>, Function>::call(
      z, targets, sums, scratch, size, aggregation);
}

/// The interval of a distance that was measured in integers, on rows of which none moved by more
/// than `moved`.
///
/// What was measured is the distance of z' to g', both on their grids, right to 4 roundings. l2 and
/// l2sq: a row that moves does to them what z does when it moves, so the two moves add up. cosine
/// and angular: u is what z' was rounded from, z / |z| but for its length, and |u - g| differs from
/// |z' - g'| by no more than both moves. cosine: half the squares of these differ by change(), as
/// there; going from u to a vector of length 1 changes half of |u - g|^2 by less than s (d + s), s
/// as there: together with s m of length_error() that is within the bound of rounding for m up to
/// 1/2. angular: |z'| and |g'| are at least 1 - m_z and 1 - m_g on the way, so that a^2 + b^2 = 2
/// |z'|^2 + 2 |g'|^2
/// >= 4 (1 - m / 2)^2, which for m = m_z + m_g up to 1/5 is at least 3.24: 2 sqrt(2) / 1.8 < 1.6
/// times m.
template <class Metric>
ETLMON_INLINE Enclosed enclose_integers(const Approximate& of, float moved, uint32_t dimension,
                                        uint32_t averaged) noexcept {
  constexpr float kGreatestTurn = 0.2f;
  const float all = rounded((moved + of.moved) * 1.000001f);
  if (Metric::kDirection && !(all <= kGreatestTurn)) return {};
  return enclose<Metric>(of.measured, all, dimension, averaged);
}

#endif

}  // namespace detail

/// The aggregated distance from z to K rows of D bytes, each worth `scale` times itself, of which
/// none is farther than `moved` from its float32 row. `Sums`: of each row the sum of its bytes'
/// squares, then of each the sum of its bytes.
template <class Metric, class Aggregation, uint32_t K, uint32_t D, const auto& Targets,
          const auto& Sums>
ETLMON_INLINE Enclosed measure_bytes(const float* z, float scale, float moved) noexcept {
  static_assert(
      in_integers(K, D) && sizeof(Targets) == K * D && sizeof(Sums) == 2 * K * sizeof(int32_t),
      "K rows of D bytes, and two sums of each");
  constexpr uint32_t kAveraged = Aggregation::kOfDistances ? K : 0;
#if defined(ETLMON_X86_64)
  alignas(64) uint8_t scratch[detail::bytes_scratch(D)];
  const auto measured = detail::best_in_integers<Metric, Aggregation, detail::Fixed<K, D>>(
      z, {&Targets[0], scale}, &Sums[0], scratch, {}, {});
  return detail::enclose_integers<Metric>(measured, moved, D, kAveraged);
#else
  return enclose<Metric>(measure_scaled<Metric, Aggregation, K, D, Targets>(z, scale), moved, D,
                         kAveraged);
#endif
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
