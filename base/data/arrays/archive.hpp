// The zip archive around the arrays of an .npz file.
// Takes: a path, or bytes in memory. Gives: the keys, and each array's bytes as a stream that is
// unpacked while it is read. Keeps true: members are stored or deflated and not encrypted; sizes
// are compared before anything is unpacked, checksums at the end of a member; failures have E04
// codes and messages that do not name the file.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/bytes.hpp"
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

}  // namespace etlc::data
