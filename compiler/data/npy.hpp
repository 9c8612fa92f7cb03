// One .npy array from any source of bytes.
// Takes: bytes and how many there are. Gives: the array. Keeps true: memory grows with the bytes that have come, not
// with what the header promises; failures have E04 codes and messages that name neither file nor array.
#pragma once

#include "data/array.hpp"
#include "data/bytes.hpp"

namespace etlc::data {

diag::Result<Array> read_npy_from(ByteSource& source);

/// The failure with `where` ("goal.npy", "goal.npz: array 'z'") before its message.
diag::Failure located(const diag::Failure& failure, const std::string& where);

}  // namespace etlc::data
