// Arrays of numbers as read from files.
// Takes: bytes. Gives: shapes and values in row-major order, whatever the order in the file.
// Keeps true: the number of values is the product of the shape; a damaged file gives a Failure that
// names the array, what was found and what was expected, and never takes more memory than its own
// size justifies.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

enum class Element : std::uint8_t { f16, f32, f64, i8, i16, i32, i64, u8, u16, u32, u64, boolean };

std::string_view name(Element element);  ///< "float32", as numpy spells it

/// Larger arrays are refused: 1 GiB as doubles.
inline constexpr std::uint64_t kMaxArrayElements = 1ULL << 27U;

struct Array {
    std::vector<std::uint64_t> shape;
    Element element = Element::f32;
    std::vector<double> values;  ///< every element type but i64/u64 above 2^53 is exact in double

    std::string shape_text() const;  ///< "(8, 32)"
};

/// One .npy file. Reads float16/32/64, integers and bool, C and Fortran order, little endian.
/// Failures of this header are E04; their messages do not repeat the path: `in_file`
/// (data/files/file.hpp) adds it.
diag::Result<Array> read_npy(const std::string& path);
/// The same from memory.
diag::Result<Array> parse_npy(std::string_view bytes);

/// One array of an .npz file, stored or deflated. An empty key takes the only array there is, else
/// it is an error.
diag::Result<Array> read_npz(const std::string& path, const std::string& key);
/// The same from memory.
diag::Result<Array> parse_npz(std::string_view bytes, const std::string& key);

/// .npy or .npz by the file's ending. An .npy file takes no key.
diag::Result<Array> read_array(const std::string& path, const std::string& key);

/// 64-bit content hash as 16 hex digits over shape and float32 bits: the same on every machine. It
/// is XXH64 with seed 0 of: the rank and the dimensions as 64-bit, then the values' IEEE bits as
/// 32-bit little-endian integers.
std::string content_hash(const std::vector<std::uint64_t>& shape, const std::vector<float>& values);

}  // namespace etlc::data
