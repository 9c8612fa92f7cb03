// The layout of a zip archive, restricted to what all readers read alike.
// Takes: the bytes. Gives: the entries of its directory, or why it is refused. Keeps true: the
// members begin at the file's first byte and follow each other without a gap, then the directory,
// then the record that ends the file. So there is no second archive before, after or between them,
// which another reader might take for the archive. Source: PKWARE, APPNOTE.TXT 6.3.10, section 4.3.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// Reads `n` bytes at `at`; false where they cannot be read.
using ReadAt = std::function<bool(std::uint64_t at, char* to, std::size_t n)>;

/// An entry of the directory.
struct ZipMember {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t packed_bytes = 0;
    std::uint64_t offset = 0;   ///< of its header
    bool sizes_follow = false;  ///< its header was written before its size was known
};

/// Reads the directory of a file of `size` bytes, in its order. Failures: E0407.
diag::Result<std::vector<ZipMember>> read_zip_layout(std::uint64_t size, const ReadAt& read);

}  // namespace etlc::data
