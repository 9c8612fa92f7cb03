// The zip archive around the arrays of an .npz file.
// Takes: a path. Gives: the keys, and each array's bytes as a stream that is
// unpacked while it is read. Keeps true: members are stored or deflated and not encrypted; sizes
// are compared before anything is unpacked, checksums at the end of a member; failures have E04
// codes and messages that do not name the file.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

struct zip;

namespace etlc::data {

class Archive {
public:
    static diag::Result<Archive> open(const std::string& path);

    /// Returns the names of the .npy members, without that ending, in the order of the archive.
    const std::vector<std::string>& keys() const { return keys_; }
    /// Opens the array `key`. Where the key is missing or occurs twice, the failure names the
    /// nearest key and lists all.
    diag::Result<std::unique_ptr<ByteSource>> member(const std::string& key) const;
    /// Returns whether the archive has a member with this full name.
    bool has_file(const std::string& name) const;
    /// Opens the member with this full name, "about.json", of at most `limit` bytes. Reading it to
    /// the end checks its checksum.
    diag::Result<std::unique_ptr<ByteSource>> file(const std::string& name,
                                                   std::uint64_t limit) const;

private:
    explicit Archive(std::shared_ptr<zip> handle);

    diag::Failure missing(const std::string& key) const;
    diag::Result<std::unique_ptr<ByteSource>> open_member(std::uint64_t index) const;

    std::shared_ptr<zip> handle_;
    std::vector<std::string> keys_;
    std::vector<std::uint64_t> indices_;  ///< places of the keys in the archive
};

// Writes arrays and texts as .npy and .npz files, like numpy.save and numpy.savez.
// Keeps true: the same members give the same bytes, on every machine and at any time.

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
