// A matrix of float32 that a spec loads or contains, and a cache of loaded ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "check/model/inputs.hpp"

namespace etlc::check {

struct Matrix {
    std::uint32_t rows = 0;
    std::uint32_t columns = 0;
    /// A one-dimensional array in a file, or a literal [1, 2, 3]; rows is then 1.
    bool one_dimensional = false;
    std::vector<float> values;  ///< row-major
    std::string origin;         ///< "targets/goal_a.npy", "file.npz:key" or "literal"
    std::string path;  ///< of the file, relative to the working directory; empty for a literal
    std::string hash;
    std::vector<EncodedRows> encoded;  ///< rows made from images
};

/// A loaded matrix, by path and key, for callers that check a spec repeatedly. It is valid while
/// the file has the same time and size.
struct KnownMatrix {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    Matrix matrix;
};
using KnownMatrices = std::map<std::pair<std::string, std::string>, KnownMatrix>;

}  // namespace etlc::check
