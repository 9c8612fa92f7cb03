// Whole files of bytes, in and out.
// Takes: a path. Gives: its bytes, or a file that appears whole or not at all.
// Keeps true: a failed write leaves what stood there before, and no temporary file; a Failure carries the code that the
// caller names and a message that does not repeat the path: `in_file` puts both together.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "diag/diag.hpp"

namespace etlc::data {

/// All bytes of a file, at most `limit`. Failures: missing, a directory, not readable, too large.
diag::Result<std::string> read_file(const std::string& path, std::uint64_t limit, diag::Code code);

/// Why `path` cannot be read as a file ("no such file", "is a directory", ...), or nothing.
std::optional<std::string> why_unreadable(const std::string& path);

/// The finding as a diagnostic whose place is `path`, with line and column where they are known.
diag::Diagnostic in_file(const diag::Failure& failure, const std::string& path);

/// A file that is written under a temporary name in its folder and takes its own name only when it is complete.
/// A path that is a device, a pipe or /dev/stdout is written to directly; of a symbolic link, the file it points to is
/// replaced.
class AtomicFile {
public:
    static diag::Result<AtomicFile> create(const std::string& path, diag::Code code);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    ~AtomicFile();  ///< removes what was not committed

    std::optional<diag::Failure> write(std::string_view bytes);
    std::optional<diag::Failure> commit();

private:
    AtomicFile(std::string path, std::string temporary, int descriptor, diag::Code code);

    std::string path_;
    std::string temporary_;  ///< empty: written directly, or done
    int descriptor_ = -1;
    diag::Code code_;
};

/// The whole of `bytes` as the content of `path`.
std::optional<diag::Failure> write_file_atomically(const std::string& path, std::string_view bytes, diag::Code code);

}  // namespace etlc::data
