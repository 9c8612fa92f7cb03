// The rows of one .npy array, in order, in constant memory.
// Takes: the bytes of the array. Gives: `width` doubles a row, `rows` times, then checks that
// nothing is left over. Keeps true: C order is read straight through. Of a Fortran-ordered array
// the first row is complete only near the end of its bytes, so it is unpacked once to an unnamed
// temporary file and read from there, a block of rows of every column.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "data/arrays/npy_header.hpp"
#include "data/files/bytes.hpp"

namespace etlc::data {

class Rows {
public:
    virtual ~Rows() = default;
    /// Must not be called more often than there are rows.
    virtual diag::Result<const double*> next() = 0;
};

/// `header` has been read from `source`; its data are `rows` x `width`. Failures have E04 codes.
diag::Result<std::unique_ptr<Rows>> open_rows(std::unique_ptr<ByteSource> source,
                                              const NpyHeader& header, std::uint64_t rows,
                                              std::uint32_t width);

}  // namespace etlc::data
