// One .npy array from any source of bytes.
// Takes: bytes and how many there are. Gives: the array. Keeps true: memory grows with the bytes
// that have come, not with what the header promises; failures have E04 codes and messages that name
// neither file nor array.
#pragma once

#include "data/arrays/array.hpp"
#include "data/files/bytes.hpp"

namespace etlc::data {

diag::Result<Array> read_npy_from(ByteSource& source);

/// The failure of the array `key` of an archive, which its message then names.
diag::Failure in_array(const diag::Failure& failure, const std::string& key);

}  // namespace etlc::data
