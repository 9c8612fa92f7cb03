// SPDX-License-Identifier: MIT
// min over a large target set without measuring all of it at every step: Search<Rows, Dim>, a
// member of the monitor. Takes: z and rows that begin at multiples of 64 bytes. Gives: the result
// of measure_stored, bit for bit, with nearest row and ties. Method: the previous nearest row is
// measured first. Blocks of 64 rows are stored with their least value from an anchor; blocks that
// cannot have come near enough since (reach.hpp) are skipped. When that has cost as much as
// measuring all rows once, all are measured and z becomes the anchor. Rows whose first quarter is
// already too far are not read to their end. Keeps true: a step measures at most all rows and two
// more.
#pragma once

#include "etlmon/distance/reach.hpp"
#include "etlmon/distance/targets.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Whether a search supports this distance and saves work; otherwise use measure_stored.
template <class Metric>
constexpr bool searches(uint32_t rows) noexcept {
  return detail::Reach<Metric>::kKnown && rows >= 256;
}

#if !defined(ETLMON_VECTORS)
namespace detail {

#define ETLMON_TARGET
#define ETLMON_WIDE ETLMON_INLINE
namespace baseline {
// clang-format off
#include "etlmon/distance/search.inc"
// clang-format on
}  // namespace baseline
#undef ETLMON_WIDE
#undef ETLMON_TARGET

template <class Metric, class Size>
ETLMON_INLINE Measured best_search(const float* z, const float* rows, SearchView state) noexcept {
  return unpacked(baseline::search<Metric, Size>(z, rows, state));
}

}  // namespace detail
#endif

/// The state of the search in one set.
template <uint32_t Rows, uint32_t Dim>
class Search {
 public:
  constexpr void reset() noexcept {
    nearest_ = 0;
    measured_ = detail::blocks_of(Rows);
  }
  /// Returns the nearest row. `rows`: Rows x Dim elements, each row at a multiple of 64 bytes; the
  /// same ones since reset().
  template <class Metric>
  Measured nearest(const float* z, const float* rows) noexcept {
    return detail::best_search<Metric, detail::Padded<Rows, Dim>>(
        z, rows, {anchor_, least_, &nearest_, &measured_});
  }

 private:
  float anchor_[Dim];
  uint32_t least_[detail::blocks_of(Rows)];
  uint32_t nearest_;
  uint32_t measured_;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
