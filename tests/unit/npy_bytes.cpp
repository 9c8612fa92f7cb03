#include "npy_bytes.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zip.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace etlc::tests {

std::string npy_dictionary(const std::string& descr, bool fortran_order, const std::string& shape) {
    return "{'descr': '" + descr + "', 'fortran_order': " + (fortran_order ? "True" : "False") +
           ", 'shape': " + shape + ", }";
}

std::string npy_raw(const std::string& dictionary, const std::string& data, int major) {
    const int length_bytes = major == 1 ? 2 : 4;
    std::string header = dictionary;
    while ((8 + static_cast<std::size_t>(length_bytes) + header.size() + 1) % 64 != 0)
        header += ' ';
    header += '\n';
    std::string result = "\x93NUMPY";
    result += static_cast<char>(major);
    result += '\0';
    return result + little_endian(header.size(), length_bytes) + header + data;
}

std::string npy(const std::string& descr, const std::string& shape, const std::string& data,
                bool fortran_order) {
    return npy_raw(npy_dictionary(descr, fortran_order, shape), data);
}

std::string floats(const std::vector<float>& values) {
    std::string result;
    for (const float value : values)
        result += little_endian(std::bit_cast<std::uint32_t>(value), 4);
    return result;
}

std::string zip_of(const std::vector<Member>& members) {
    const TemporaryPath file("made.zip");
    int error = 0;
    zip_t* archive = zip_open(file.path().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    EXPECT_NE(archive, nullptr) << error;
    for (const Member& member : members) {
        zip_source_t* source =
            zip_source_buffer(archive, member.bytes.data(), member.bytes.size(), 0);
        const zip_int64_t index =
            zip_file_add(archive, member.name.c_str(), source, ZIP_FL_ENC_UTF_8);
        EXPECT_GE(index, 0) << member.name;
        const auto i = static_cast<zip_uint64_t>(index);
        zip_set_file_compression(archive, i, member.deflated ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 1);
        zip_file_set_mtime(archive, i, 315532800, 0);
        if (member.encrypted) {
            EXPECT_EQ(zip_file_set_encryption(archive, i, ZIP_EM_AES_128, "word"), 0);
        }
    }
    EXPECT_EQ(zip_close(archive), 0);
    return file_bytes(file.path());
}

std::string patched(std::string bytes, const std::string& from, const std::string& to) {
    EXPECT_EQ(from.size(), to.size());
    std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << "nothing to patch";
    for (; at != std::string::npos; at = bytes.find(from, at + to.size()))
        bytes.replace(at, to.size(), to);
    return bytes;
}

std::string little_endian(std::uint64_t n, int width) {
    std::string result;
    for (int i = 0; i < width; ++i) result += static_cast<char>((n >> (8 * i)) & 0xff);
    return result;
}

TemporaryPath::TemporaryPath(const std::string& name) {
    folder_ = ::testing::TempDir() + "etlc_test.XXXXXX";
    EXPECT_NE(::mkdtemp(folder_.data()), nullptr);
    path_ = folder_ + "/" + name;
}

TemporaryPath::TemporaryPath(const std::string& name, const std::string& bytes)
    : TemporaryPath(name) {
    std::ofstream(path_, std::ios::binary) << bytes;
}

TemporaryPath::~TemporaryPath() {
    std::filesystem::remove_all(folder_);
}

std::string file_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file.good()) << path;
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

diag::Result<data::Array> parse_npy(const std::string& bytes) {
    return data::read_npy(TemporaryPath("array.npy", bytes).path());
}

diag::Result<data::Array> parse_npz(const std::string& bytes, const std::string& key) {
    return data::read_npz(TemporaryPath("arrays.npz", bytes).path(), key);
}

}  // namespace etlc::tests
