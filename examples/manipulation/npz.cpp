#include "npz.hpp"

#include <fmt/core.h>
#include <zip.h>

#include <cstring>
#include <stdexcept>

namespace manipulation {

namespace {

/// Writes NumPy's format 1.0: magic, length of the header, the header padded to 64 bytes, the
/// numbers.
std::string npy(const Rows& rows) {
    const std::string shape = rows.cols() == 1 ? fmt::format("({},)", rows.rows())
                                               : fmt::format("({}, {})", rows.rows(), rows.cols());
    std::string header =
        fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': {}, }}", shape);
    header += std::string(63 - (header.size() + 10) % 64, ' ') + '\n';
    std::string result("\x93NUMPY\x01\x00", 8);
    result += static_cast<char>(header.size() % 256);
    result += static_cast<char>(header.size() / 256);
    result += header;
    const auto bytes = static_cast<std::size_t>(rows.size()) * sizeof(float);
    result.resize(result.size() + bytes);
    std::memcpy(result.data() + result.size() - bytes, rows.data(), bytes);
    return result;
}

}  // namespace

void write_npz(const std::string& path, const std::map<std::string, Rows>& arrays) {
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    if (archive == nullptr) throw std::runtime_error(path + " cannot be written");
    std::map<std::string, std::string> files;  // libzip reads them when it closes
    for (const auto& [name, rows] : arrays) {
        const std::string& file = files[name] = npy(rows);
        zip_source_t* source = zip_source_buffer(archive, file.data(), file.size(), 0);
        const zip_int64_t index = zip_file_add(archive, (name + ".npy").c_str(), source, 0);
        zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, 0x21, 0);
        zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
    }
    if (zip_close(archive) != 0) throw std::runtime_error(path + ": " + zip_strerror(archive));
}

}  // namespace manipulation
