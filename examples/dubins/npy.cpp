#include "npy.hpp"

#include <bit>
#include <fstream>
#include <stdexcept>

#include "data/arrays/array.hpp"

namespace demo {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

Eigen::MatrixXf read_matrix(const std::string& path, Eigen::Index rows, Eigen::Index columns) {
    const auto array = etlc::data::read_npy(path);
    if (!array) throw std::runtime_error(array.failure().message);
    const std::vector<std::uint64_t> wanted = {static_cast<std::uint64_t>(rows),
                                               static_cast<std::uint64_t>(columns)};
    if (array->shape != wanted)
        throw std::runtime_error(path + ": unexpected shape " + array->shape_text());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const RowMajor>(array->values.data(), rows, columns).cast<float>();
}

void write_matrix(const std::string& path, const Eigen::MatrixXf& matrix) {
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                         std::to_string(matrix.rows()) + ", " + std::to_string(matrix.cols()) +
                         "), }";
    header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 10 - 1,
                  ' ');  // the values start at a multiple of 64
    header += '\n';
    std::ofstream file(path, std::ios::binary);
    file.write("\x93NUMPY\x01\x00", 8);
    file.put(static_cast<char>(header.size() % 256)).put(static_cast<char>(header.size() / 256));
    file << header;
    const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
    file.write(reinterpret_cast<const char*>(rows.data()),
               rows.size() * static_cast<std::streamsize>(sizeof(float)));
    file.close();
    if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace demo
