// Reads and writes float matrices in .npy files: the encoder and the target sets.
// Takes: a path. Gives: rows x columns float32, row by row in little-endian order. Keeps true: a
// file of another form throws an exception that names the file.
#pragma once

#include <Eigen/Core>
#include <string>

namespace demo {

/// Throws std::runtime_error if the file cannot be read or has another shape.
Eigen::MatrixXf read_matrix(const std::string& path, Eigen::Index rows, Eigen::Index columns);

/// Throws std::runtime_error if the file cannot be written.
void write_matrix(const std::string& path, const Eigen::MatrixXf& matrix);

}  // namespace demo
