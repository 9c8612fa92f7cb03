// Whole files of bytes, and paths.
// Keeps true: a Failure carries the caller's code and a message that does not repeat the path:
// `in_file` adds it.
#pragma once

#include <cstdint>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// Describes an errno as messages do: "no such file", "permission denied".
std::string error_words(int error);

/// Whether pipes and devices are read. They may never end, so only a file that a user names and
/// that is read once may be one.
enum class Streams : std::uint8_t { refused, taken };

/// Says why `path` cannot be read as a file: "no such file", "is a directory", ...
std::optional<std::string> why_unreadable(const std::string& path,
                                          Streams streams = Streams::refused);

/// Reads all bytes of a file. Failures: why_unreadable, more than `limit` bytes.
diag::Result<std::string> read_file(const std::string& path, std::uint64_t limit, diag::Code code,
                                    Streams streams = Streams::refused);

diag::Failure out_of_memory();

/// Returns the diag::Result of `read`, or out_of_memory() where memory runs out on the way.
template <class Read>
auto within_memory(Read read) -> decltype(read()) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {  // a container of more elements than can be counted
    }
    return out_of_memory();
}

/// Makes a diagnostic at `path`, with line and column where they are known.
diag::Diagnostic in_file(const diag::Failure& failure, const std::string& path);

/// Returns whether a file is what Git LFS leaves in a clone in place of a large file.
bool is_lfs_pointer(const std::string& path);

inline constexpr const char* kIsLfsPointer =
    "is a pointer of Git LFS in place of the file; `git lfs pull` fetches it";

/// Resolves a path that is relative to the folder of `file`, without making it absolute.
std::string beside(const std::string& file, const std::string& path);

/// Returns a pattern that matches this path alone.
std::string literal(const std::string& path);

/// Returns the paths that match, sorted bytewise; nothing where a folder cannot be read.
std::optional<std::vector<std::string>> paths_matching(const std::string& pattern);

/// Returns whether a path has one of these endings, ".mp4", in any case.
bool has_ending(const std::string& path, const std::vector<std::string>& endings);

/// Returns whether the ending of a path is that of an image.
bool is_image(const std::string& path);
/// Returns ".png, .jpg or .jpeg".
std::string image_endings();

/// Finds the images that `path` names, an image, a folder or a pattern, relative to `folder`. They
/// are sorted bytewise, whatever the file system or the locale. Failures are E1009.
diag::Result<std::vector<std::string>> find_images(const std::string& folder,
                                                   const std::string& path);

}  // namespace etlc::data
