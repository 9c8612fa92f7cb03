// Whole files of bytes.
// Takes: a path. Gives: its bytes. Keeps true: a Failure carries the code that the caller names and
// a message that does not repeat the path: `in_file` puts both together.
#pragma once

#include <cstdint>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "diag/diag.hpp"

namespace etlc::data {

/// An errno in the words of a message: "no such file", "permission denied".
std::string error_words(int error);

/// Pipes and devices, of which nobody knows whether they ever end, or begin: only what a user names
/// and what is read once may be one.
enum class Streams : std::uint8_t { refused, taken };

/// Why `path` cannot be read as a file ("no such file", "is a directory", ...), or nothing.
std::optional<std::string> why_unreadable(const std::string& path,
                                          Streams streams = Streams::refused);

/// All bytes of a file, at most `limit`. Failures: why_unreadable, too large.
diag::Result<std::string> read_file(const std::string& path, std::uint64_t limit, diag::Code code,
                                    Streams streams = Streams::refused);

diag::Failure out_of_memory();

/// What `read` gives, a diag::Result; out_of_memory() where memory runs out on the way.
template <class Read>
auto within_memory(Read read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {  // a container of more elements than can be counted
    }
    return out_of_memory();
}

/// The finding as a diagnostic whose place is `path`, with line and column where they are known.
diag::Diagnostic in_file(const diag::Failure& failure, const std::string& path);

}  // namespace etlc::data
