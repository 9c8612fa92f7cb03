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

/// Where an archive lies: a file, or bytes that outlive it.
struct ArchivePlace {
    std::string path;
    std::string_view bytes;
    bool in_memory = false;
};

class Archive {
public:
    static diag::Result<Archive> open(const ArchivePlace& place);

    /// Names of the members that end in .npy, without that ending, in the order of the archive.
    const std::vector<std::string>& keys() const { return keys_; }
    /// The array `key`. No such key, or two of them, is a failure that names the nearest and lists
    /// what there is.
    diag::Result<std::unique_ptr<ByteSource>> member(const std::string& key) const;
    /// Whether there is a member with this whole name.
    bool has_file(const std::string& name) const;
    /// The bytes of the member with this whole name, "about.json". At most `limit`. Whoever reads
    /// on to the end is told where they do not have their checksum.
    diag::Result<std::unique_ptr<ByteSource>> file(const std::string& name,
                                                   std::uint64_t limit) const;

private:
    explicit Archive(std::shared_ptr<zip> handle);

    diag::Failure missing(const std::string& key) const;
    diag::Result<std::unique_ptr<ByteSource>> open_member(std::uint64_t index) const;

    std::shared_ptr<zip> handle_;
    std::vector<std::string> keys_;
    std::vector<std::uint64_t> indices_;  ///< of the keys in the archive
};

}  // namespace etlc::data
