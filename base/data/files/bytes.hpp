// Where bytes come from: a file, memory, or a member of an archive.
// Takes: a path or bytes. Gives: them in order, a buffer at a time.
// Keeps true: `read` gives less than asked for only at the end; `size` is what the container says,
// known before reading.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

class ByteSource {
public:
    virtual ~ByteSource() = default;
    /// Up to `n` bytes; fewer only at the end. A source that keeps a checksum fails here where it
    /// does not match.
    virtual diag::Result<std::size_t> read(char* to, std::size_t n) = 0;
    virtual std::uint64_t size() const = 0;
};

/// A regular file, or (size 0) a stream that can be read to its end.
diag::Result<std::unique_ptr<ByteSource>> open_file(const std::string& path,
                                                    Streams streams = Streams::refused);

/// Standard input: of a pipe `read` gives what is there, so only 0 bytes are the end.
std::unique_ptr<ByteSource> standard_input();

/// The bytes must outlive the source.
std::unique_ptr<ByteSource> from_memory(std::string_view bytes);

}  // namespace etlc::data
