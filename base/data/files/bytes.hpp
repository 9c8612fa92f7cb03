// Sources of bytes: a file, memory, or a member of an archive.
// Keeps true: `read` returns less than requested only at the end; `size` is what the container
// declares, known before reading.
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
    /// Reads up to `n` bytes; fewer only at the end. Fails where a checksum does not match.
    virtual diag::Result<std::size_t> read(char* to, std::size_t n) = 0;
    virtual std::uint64_t size() const = 0;
};

/// Opens a regular file, or a stream that can be read to its end, whose size is 0.
diag::Result<std::unique_ptr<ByteSource>> open_file(const std::string& path,
                                                    Streams streams = Streams::refused);

/// Opens standard input. `read` returns what a pipe holds, so only 0 bytes are the end.
std::unique_ptr<ByteSource> standard_input();

/// Reads from bytes that outlive the source.
std::unique_ptr<ByteSource> from_memory(std::string_view bytes);

}  // namespace etlc::data
