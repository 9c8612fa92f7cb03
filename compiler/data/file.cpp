#include "data/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace etlc::data {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string words(int error) {
    switch (error) {
        case ENOENT:
        case ENOTDIR: return "no such file";
        case EISDIR: return "is a directory, expected a file";
        case EACCES:
        case EPERM: return "permission denied";
        case ENOSPC: return "no space left on the device";
        default: return std::strerror(error);
    }
}

/// The file that a chain of symbolic links ends at; `path` itself where it is none, or where its end does not exist.
std::string behind_links(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr), &std::free);
    return real ? std::string(real.get()) : path;
}

}  // namespace

std::optional<std::string> why_unreadable(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return words(errno);
    if (S_ISDIR(status.st_mode)) return words(EISDIR);
    if (::access(path.c_str(), R_OK) != 0) return words(errno);
    return {};
}

diag::Result<std::string> read_file(const std::string& path, std::uint64_t limit, diag::Code code) {
    if (auto why = why_unreadable(path)) return diag::Failure{code, *why};
    const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
    if (!file) return diag::Failure{code, words(errno)};
    std::string bytes;
    std::array<char, 1U << 16U> buffer;
    for (;;) {
        const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file.get());
        if (bytes.size() + n > limit)
            return diag::Failure{code, fmt::format("is larger than {} bytes, the most that is read", limit)};
        bytes.append(buffer.data(), n);
        if (n < buffer.size()) break;
    }
    if (std::ferror(file.get()) != 0) return diag::Failure{code, fmt::format("cannot be read: {}", words(errno))};
    return bytes;
}

diag::Diagnostic in_file(const diag::Failure& failure, const std::string& path) {
    diag::Diagnostic result{};
    result.code = failure.code;
    result.message = failure.message;
    result.file = path;
    result.line = failure.line;
    result.column = failure.column;
    return result;
}

AtomicFile::AtomicFile(std::string path, std::string temporary, int descriptor, diag::Code code)
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor), code_(code) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      code_(other.code_) {}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

diag::Result<AtomicFile> AtomicFile::create(const std::string& path, diag::Code code) {
    const auto refuse = [&](int error) {
        // A missing file is no obstacle to writing; ENOENT is about its folder.
        const bool no_folder = error == ENOENT || error == ENOTDIR;
        return diag::Failure{code, fmt::format("cannot be written: {}", no_folder ? "no such folder" : words(error))};
    };
    // Standard output is written where it stands: behind it may be a file that others write to as well.
    if (path == "/dev/stdout") {
        const int descriptor = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
        if (descriptor < 0) return refuse(errno);
        return AtomicFile(path, {}, descriptor, code);
    }
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) return refuse(EISDIR);
    if (exists && !S_ISREG(status.st_mode)) {
        const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor < 0) return refuse(errno);
        return AtomicFile(path, {}, descriptor, code);
    }
    if (exists && ::access(path.c_str(), W_OK) != 0) return refuse(errno);
    const std::string target = behind_links(path);
    for (unsigned attempt = 0;; ++attempt) {
        std::string temporary = fmt::format("{}.{}.{}.part", target, ::getpid(), attempt);
        const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) return AtomicFile(target, std::move(temporary), descriptor, code);
        if (errno != EEXIST || attempt == 1000) return refuse(errno);
    }
}

std::optional<diag::Failure> AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return diag::Failure{code_, fmt::format("cannot be written: {}", words(errno))};
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return {};
}

std::optional<diag::Failure> AtomicFile::commit() {
    const auto failed = [&] { return diag::Failure{code_, fmt::format("cannot be written: {}", words(errno))}; };
    // Some file systems report a full disk only here.
    if (::close(std::exchange(descriptor_, -1)) != 0) return failed();
    if (temporary_.empty()) return {};
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) return failed();
    temporary_.clear();
    return {};
}

std::optional<diag::Failure> write_file_atomically(const std::string& path, std::string_view bytes, diag::Code code) {
    auto file = AtomicFile::create(path, code);
    if (!file) return file.failure();
    if (auto failure = file->write(bytes)) return failure;
    return file->commit();
}

}  // namespace etlc::data
