// Arrays of numbers as read from files.
// Takes: bytes. Gives: shapes and values in row-major order, whatever the order in the file.
// Keeps true: the number of values is the product of the shape; a damaged file gives a Failure that
// names the array, what was found and what was expected, and never takes more memory than its own
// size justifies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

enum class Element : std::uint8_t { f16, f32, f64, i8, i16, i32, i64, u8, u16, u32, u64, boolean };

std::string_view name(Element element);  ///< "float32", as in numpy

/// The largest array that is read: 1 GiB as doubles.
inline constexpr std::uint64_t kMaxArrayElements = 1ULL << 27U;

struct Array {
    std::vector<std::uint64_t> shape;
    Element element = Element::f32;
    std::vector<double> values;  ///< every element type but i64/u64 above 2^53 is exact in double

    std::string shape_text() const;  ///< "(8, 32)"
};

/// Reads a .npy file: float16/32/64, integers and bool, C and Fortran order, little endian.
/// Failures of this header are E04; their messages do not repeat the path: `in_file`
/// (data/files/file.hpp) adds it.
diag::Result<Array> read_npy(const std::string& path);

/// Reads an array of an .npz file, stored or deflated. An empty key takes the only array, and is an
/// error where there are several.
diag::Result<Array> read_npz(const std::string& path, const std::string& key);

/// Reads an .npy or .npz file, by its ending. An .npy file takes no key.
diag::Result<Array> read_array(const std::string& path, const std::string& key);

/// Returns a hash of the content as 16 hex digits, the same on every machine: XXH64 with seed 0 of
/// the rank and the dimensions as 64-bit, then the values' IEEE bits as 32-bit little-endian
/// integers.
std::string content_hash(const std::vector<std::uint64_t>& shape, const std::vector<float>& values);

/// Reads a .npy array from any source. Memory grows with the bytes that have arrived, not with what
/// the header promises.
diag::Result<Array> read_npy_from(ByteSource& source);

/// Adds the name of the array to a failure.
diag::Failure in_array(const diag::Failure& failure, const std::string& key);

// The header of an .npy array: a magic word, a version, and a Python dictionary literal.
// Takes: the bytes before the data. Gives: element type, order, shape. Source: numpy.lib.format,
// versions 1.0, 2.0 and 3.0. Keeps true: the number of elements and of bytes fits 63 bits; what the
// header promises is only read; the caller compares it with the bytes.

struct NpyHeader {
    Element element = Element::f32;
    bool fortran_order = false;
    std::vector<std::uint64_t> shape;
    std::uint64_t count = 1;         ///< product of the shape
    std::uint64_t header_bytes = 0;  ///< where the data begin

    std::uint64_t data_bytes() const;
};

/// Reads up to the first byte of data. Failures have E04 codes and messages that name neither file
/// nor array.
diag::Result<NpyHeader> read_npy_header(ByteSource& source);

/// Returns a failure unless `total` bytes, header included, are exactly what the array takes.
std::optional<diag::Failure> check_size(const NpyHeader& header, std::uint64_t total);

/// Returns a shape as numpy writes it: "(8, 32)".
std::string shape_text(const std::vector<std::uint64_t>& shape);

// The element types of arrays: their names, and the conversion of their bytes to numbers.
// Takes: little-endian bytes as in .npy files. Gives: doubles.
// Keeps true: every float16, float32 and integer up to 2^53 converts exactly.

struct ElementInfo {
    Element element;
    std::string_view code;  ///< the descr of .npy files without its byte order: "f4"
    std::string_view name;  ///< the name in numpy: "float32"
    std::uint32_t bytes;
};

const ElementInfo& info(Element element);
/// Returns the element type with this code, "f4".
std::optional<Element> element_of_code(std::string_view code);

/// Converts IEEE 754 binary16 to double, exactly, NaN and infinities included.
double half_to_double(std::uint16_t bits);

/// Converts `n` elements. Returns how many are valid: fewer than `n` where a boolean byte is
/// neither 0 nor 1.
std::size_t decode(Element element, const char* bytes, std::size_t n, double* to);

}  // namespace etlc::data
