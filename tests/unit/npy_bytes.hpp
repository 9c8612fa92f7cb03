// Bytes of .npy and .npz files for tests, valid and broken.
// Takes: header parts, members. Gives: the file's bytes. Keeps true: nothing is checked, so tests
// can write inconsistent files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data/arrays/array.hpp"

namespace etlc::tests {

/// Returns a header dictionary as numpy writes it.
std::string npy_dictionary(const std::string& descr, bool fortran_order, const std::string& shape);

/// Returns magic, version, length, `dictionary` padded to 64 bytes and a line feed, `data`.
std::string npy_raw(const std::string& dictionary, const std::string& data, int major = 1);

/// Returns npy_raw(npy_dictionary(...), data).
std::string npy(const std::string& descr, const std::string& shape, const std::string& data,
                bool fortran_order = false);

/// Returns the little-endian bytes of float32 numbers.
std::string floats(const std::vector<float>& values);

struct Member {
    std::string name;
    std::string bytes;
    bool deflated = true;
    bool encrypted = false;
};

/// Returns a zip archive of the members, made by libzip in a temporary file.
std::string zip_of(const std::vector<Member>& members);

/// Returns `bytes` with every `from` replaced by `to`, of the same length. Fails the test if there
/// is none.
std::string patched(std::string bytes, const std::string& from, const std::string& to);

/// Returns `n` as `width` little-endian bytes.
std::string little_endian(std::uint64_t n, int width);

/// A file in the test's temporary folder, removed with the object.
class TemporaryPath {
public:
    explicit TemporaryPath(const std::string& name);
    TemporaryPath(const std::string& name, const std::string& bytes);
    TemporaryPath(const TemporaryPath&) = delete;
    TemporaryPath& operator=(const TemporaryPath&) = delete;
    ~TemporaryPath();

    const std::string& path() const { return path_; }

private:
    std::string folder_;
    std::string path_;
};

std::string file_bytes(const std::string& path);

/// Read the array in a file of these bytes.
diag::Result<data::Array> parse_npy(const std::string& bytes);
diag::Result<data::Array> parse_npz(const std::string& bytes, const std::string& key);

}  // namespace etlc::tests
