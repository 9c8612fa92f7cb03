// The header of an .npy array: a magic word, a version, and a Python dictionary literal.
// Takes: the bytes before the data. Gives: element type, order, shape. Source: numpy.lib.format,
// versions 1.0, 2.0 and 3.0. Keeps true: the number of elements and of bytes fits 63 bits; what the
// header promises is only read; the caller compares it with the bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data/arrays/array.hpp"
#include "data/files/bytes.hpp"

namespace etlc::data {

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

}  // namespace etlc::data
