// SPDX-License-Identifier: MIT
// The order of additions within a row, and the layout of target sets in rows or columns. Takes: the
// numbers of rows and of elements. Gives: order(), in_columns(), and the set in columns, made by
// the compiler. Keeps true: both depend only on these numbers, so kernels with constant sizes and
// with sizes known at run time compute the same sums; all rows of a set are added in the same
// order, so equal rows have equal distances.
#pragma once

#include "etlmon/bits.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {
namespace detail {

#if defined(ETLMON_VECTORS)
constexpr bool kHasVectors = true;
#else
constexpr bool kHasVectors = false;
#endif

constexpr uint32_t kLanes = 16;        ///< floats of the widest vector
constexpr uint32_t kRowsTogether = 4;  ///< rows that are read at once without vectors

enum class Order : uint8_t {
  sequential,  ///< all elements into one sum
  lanes,       ///< element i into sum i mod 16
  two_chunks,  ///< element i into sum i mod 32: one or two rows have too few sums to hide the
               ///< latency of additions
  four_chunks  ///< element i into sum i mod 64; also for sets beyond the first-level cache, which
               ///< are read in one stream
};

/// Returns the length of a column with vectors: the rows, and copies of the last one up to whole
/// vectors.
constexpr uint32_t column_length(uint32_t rows) noexcept {
  return (rows + kLanes - 1) / kLanes * kLanes;
}

/// Returns whether a set is stored in columns: many short rows, so that each lane has a row and no
/// sum over lanes is needed; without vectors, four rows or more, of which four are read in one
/// stream. The limit keeps constant evaluation within the compiler's defaults. `vectors`: whether
/// the machine has some; the compiler asks about both kinds.
constexpr bool in_columns(uint32_t rows, uint32_t dimension, bool vectors = kHasVectors) noexcept {
  constexpr uint32_t kMost = 16384;
  if (!vectors) return rows >= kRowsTogether && rows <= kMost / dimension;
  const bool short_rows =
      (dimension < kLanes && rows > 4) || (dimension <= 4 * kLanes && rows >= 2 * kLanes);
  return short_rows && rows <= kMost && column_length(rows) <= kMost / dimension;
}

/// Returns the number of elements of a set in columns.
constexpr size_t column_elements(uint32_t rows, uint32_t dimension,
                                 bool vectors = kHasVectors) noexcept {
  return size_t{dimension} * (vectors ? column_length(rows) : rows);
}

constexpr Order order(uint32_t rows, uint32_t dimension) noexcept {
  if (!kHasVectors || dimension < kLanes || in_columns(rows, dimension)) return Order::sequential;
  constexpr uint32_t kCached = 1u << 14;  // 64 KiB
  if (rows == 1 || rows > kCached / dimension) return Order::four_chunks;
  return rows == 2 ? Order::two_chunks : Order::lanes;
}

/// Returns the position of the first element of row k in columns, and the distance to the next one.
/// With vectors the whole set is one block of columns; without, every four rows are, and the rest
/// stays in rows.
struct Place {
  size_t first, stride;
};
constexpr Place place_in_columns(uint32_t k, uint32_t rows, uint32_t dimension) noexcept {
  if (kHasVectors) return {k, column_length(rows)};
  const uint32_t in_four = k % kRowsTogether, four = k - in_four;
  if (four + kRowsTogether > rows) return {size_t{k} * dimension, 1};
  return {size_t{four} * dimension + in_four, kRowsTogether};
}

/// A target set in columns.
template <uint32_t Rows, uint32_t Dim, class Element = float>
struct Columns {
  static constexpr uint32_t kRows = kHasVectors ? column_length(Rows) : Rows;
  alignas(64) Element values[column_elements(Rows, Dim)];
};

template <uint32_t Rows, uint32_t Dim, class Element>
constexpr void put_in_columns(const Element* rows, Columns<Rows, Dim, Element>& columns) noexcept {
  for (uint32_t k = 0; k < columns.kRows; ++k) {
    const Place place = place_in_columns(k, Rows, Dim);
    const Element* row = rows + (k < Rows ? k : Rows - 1) * Dim;
    for (uint32_t i = 0; i < Dim; ++i) columns.values[place.first + i * place.stride] = row[i];
  }
}

template <uint32_t Rows, uint32_t Dim, class Element>
constexpr Columns<Rows, Dim, Element> columns_of(const Element (&rows)[Rows * Dim]) noexcept {
  Columns<Rows, Dim, Element> columns{};
  put_in_columns(rows, columns);
  return columns;
}

/// The columns of a constant set.
template <uint32_t Rows, uint32_t Dim, const auto& Targets>
struct ColumnsOf {
  static constexpr auto kColumns = columns_of<Rows, Dim>(Targets);
};

/// Sizes known at compile time, and at run time. stride(): floats from a row to the next.
template <uint32_t Rows, uint32_t Dim>
struct Fixed {
  static constexpr uint32_t rows() noexcept { return Rows; }
  static constexpr uint32_t dimension() noexcept { return Dim; }
  static constexpr uint32_t stride() noexcept { return Dim; }
  static constexpr bool may_be(Order which) noexcept { return order(Rows, Dim) == which; }
  /// Returns whether rows are shorter than a vector, and not added up in lanes.
  static constexpr bool is_short() noexcept { return Dim < kLanes; }
  /// Returns whether there are too few elements for vectors of 64 bytes. Distances of directions
  /// begin with |z|.
  static constexpr bool is_small(bool of_directions) noexcept {
    return !in_columns(Rows, Dim) &&
           (Dim < 2 * kLanes || uint64_t{Rows} * Dim <= (of_directions ? 256 : 64));
  }
  /// Returns whether a tile of tile_rows rows occurs, if tiles have `most` rows, then half of that,
  /// and so on.
  static constexpr bool has_tile(uint32_t tile_rows, uint32_t most) noexcept {
    return tile_rows == most ? Rows >= tile_rows : (Rows & tile_rows) != 0;
  }
  /// For a row in blocks of `vectors` vectors of kLanes: whether there are such blocks, the most
  /// vectors after them, and whether a part of a vector is left.
  static constexpr bool has_blocks(uint32_t vectors) noexcept { return Dim >= vectors * kLanes; }
  static constexpr uint32_t vectors_after_blocks(uint32_t vectors) noexcept {
    return Dim / kLanes % vectors;
  }
  static constexpr bool has_rest() noexcept { return Dim % kLanes != 0; }
};
/// Returns the stride of rows that begin at multiples of 64 bytes, as in a file of targets.
constexpr uint32_t padded(uint32_t dimension) noexcept {
  return (dimension + kLanes - 1) / kLanes * kLanes;
}
template <uint32_t Rows, uint32_t Dim>
struct Padded : Fixed<Rows, Dim> {
  static constexpr uint32_t stride() noexcept { return padded(Dim); }
};
struct Sizes {
  uint32_t row_count, element_count;
  constexpr uint32_t rows() const noexcept { return row_count; }
  constexpr uint32_t dimension() const noexcept { return element_count; }
  constexpr uint32_t stride() const noexcept { return element_count; }
  static constexpr bool may_be(Order) noexcept { return true; }
  static constexpr bool is_short() noexcept { return false; }
  static constexpr bool is_small(bool) noexcept { return false; }
  static constexpr bool has_tile(uint32_t, uint32_t) noexcept { return true; }
  static constexpr bool has_blocks(uint32_t) noexcept { return true; }
  static constexpr uint32_t vectors_after_blocks(uint32_t vectors) noexcept { return vectors - 1; }
  static constexpr bool has_rest() noexcept { return true; }
};
/// One row of a set; only is_short() is known at compile time.
template <bool Short>
struct RowSize : Sizes {
  static constexpr bool is_short() noexcept { return Short; }
};

}  // namespace detail
}  // namespace ETLMON_BUILD
}  // namespace etlmon
