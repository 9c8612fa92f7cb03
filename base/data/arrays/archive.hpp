// The zip archive around the arrays of an .npz file.
// Takes: a path, or bytes in memory. Gives: the keys, and each array's bytes as a stream that is
// unpacked while it is read. Keeps true: members are stored or deflated and not encrypted; sizes
// are compared before anything is unpacked, checksums at the end of a member; failures have E04
// codes and messages that do not name the file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

struct zip;

namespace etlc::data {

/// The location of an archive: a file, or bytes that outlive the archive.
struct ArchivePlace {
    std::string path;
    std::string_view bytes;
    bool in_memory = false;
};

class Archive {
public:
    static diag::Result<Archive> open(const ArchivePlace& place);

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

// The layout of a zip archive, restricted to what all readers read alike.
// Takes: the bytes. Gives: the entries of its directory, or why it is refused. Keeps true: the
// members begin at the file's first byte and follow each other without a gap, then the directory,
// then the record that ends the file. So there is no second archive before, after or between them,
// which another reader might take for the archive. Source: PKWARE, APPNOTE.TXT 6.3.10, section 4.3.

/// Reads `n` bytes at `at`; false where they cannot be read.
using ReadAt = std::function<bool(std::uint64_t at, char* to, std::size_t n)>;

/// An entry of the directory.
struct ZipMember {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t packed_bytes = 0;
    std::uint64_t offset = 0;   ///< of its header
    bool sizes_follow = false;  ///< its header was written before its size was known
};

/// Reads the directory of a file of `size` bytes, in its order. Failures: E0407.
diag::Result<std::vector<ZipMember>> read_zip_layout(std::uint64_t size, const ReadAt& read);

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
