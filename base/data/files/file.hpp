// Whole files of bytes, and paths.
// Keeps true: a Failure carries the caller's code and a message that does not repeat the path:
// `in_file` adds it.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
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

// File descriptors.
// Keeps true: a descriptor is closed with its object; interrupted calls are repeated; `errno` holds
// the reason of a failure.

class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept;
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();

    int operator*() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }

private:
    int number_;
};

/// Repeats a system call until no signal interrupts it.
template <class Call>
auto uninterrupted(Call call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

/// Writes all of `bytes`; false where they cannot be written.
bool write_all(int descriptor, std::string_view bytes);

/// Reads `n` bytes at `at`; false where that fails, with EIO where the file is too short.
bool read_all_at(int descriptor, std::uint64_t at, char* to, std::size_t n);

// Sources of bytes: a file, memory, or a member of an archive.
// Keeps true: `read` returns less than requested only at the end; `size` is what the container
// declares, known before reading.

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
