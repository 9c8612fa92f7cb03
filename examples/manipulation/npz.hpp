// Writes episodes as .npz files.
// Takes: arrays of float32 by name, one row per step. Gives: a file that numpy and etlc read. Keeps
// true: the same arrays give the same bytes.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

namespace manipulation {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Writes an array of one column with one dimension. Throws std::runtime_error.
void write_npz(const std::string& path, const std::map<std::string, Rows>& arrays);

}  // namespace manipulation
