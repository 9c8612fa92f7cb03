// How a zip archive lies in its file: as one that every reader reads alike.
// Takes: the bytes. Gives: what its directory lists, or why it is refused. Keeps true: the members
// begin at the file's first byte and follow each other without a gap, then the directory, then the
// record that ends the file. So there is no second archive before, behind or between them, of which
// one reader would take the first and another the last. Source: PKWARE, APPNOTE.TXT 6.3.10, section
// 4.3.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// `n` bytes from `at` on; false where they cannot be read.
using ReadAt = std::function<bool(std::uint64_t at, char* to, std::size_t n)>;

/// A member, as the directory has it.
struct ZipMember {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t packed_bytes = 0;
    std::uint64_t offset = 0;   ///< of its header
    bool sizes_follow = false;  ///< its header was written before its size was known
};

/// The members in the order of the directory, of a file of `size` bytes. Failures: E0407.
diag::Result<std::vector<ZipMember>> read_zip_layout(std::uint64_t size, const ReadAt& read);

}  // namespace etlc::data
