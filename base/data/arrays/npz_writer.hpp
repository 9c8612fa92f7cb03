// Writes arrays and texts as .npy and .npz files, like numpy.save and numpy.savez.
// Keeps true: the same members give the same bytes, on every machine and at any time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace etlc::data {

/// Writes values in row-major order, one for each element of the shape, as float32.
std::string npy_bytes(const std::vector<std::uint64_t>& shape, const std::vector<float>& values);
/// Writes values in row-major order as uint8.
std::string npy_of_uint8(const std::vector<std::uint64_t>& shape,
                         const std::vector<std::uint8_t>& values);

struct ArchiveMember {
    std::string name;  ///< with its ending: "goal.npy"
    std::string bytes;
};

/// Writes a zip archive that stores its members in this order, without times.
std::string npz_bytes(const std::vector<ArchiveMember>& members);

}  // namespace etlc::data
