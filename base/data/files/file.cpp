#include "data/files/file.hpp"

#include <glob.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <utility>

namespace etlc::data {

namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

const std::vector<std::string> kImageEndings = {".png", ".jpg", ".jpeg"};

}  // namespace

std::string error_words(int error) {
    switch (error) {
        case ENOENT:
        case ENOTDIR: return "no such file";
        case EISDIR: return "is a directory, expected a file";
        case EACCES:
        case EPERM: return "permission denied";
        case ENOSPC: return "no space left on the device";
        case ENOMEM: return "not enough memory";
        case EBADF: return "it is closed";
        case EFBIG: return "larger than a file may be";
        default: return std::strerror(error);
    }
}

std::optional<std::string> why_unreadable(const std::string& path, Streams streams) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return error_words(errno);
    if (S_ISDIR(status.st_mode)) return error_words(EISDIR);
    if (streams == Streams::refused && !S_ISREG(status.st_mode))
        return fmt::format("is a {}, expected a file", S_ISFIFO(status.st_mode)   ? "pipe"
                                                       : S_ISSOCK(status.st_mode) ? "socket"
                                                                                  : "device");
    if (::access(path.c_str(), R_OK) != 0) return error_words(errno);
    return {};
}

diag::Result<std::string> read_file(const std::string& path, std::uint64_t limit, diag::Code code,
                                    Streams streams) {
    if (auto why = why_unreadable(path, streams)) return diag::Failure{code, *why};
    const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rbe"));
    if (!file) return diag::Failure{code, error_words(errno)};
    std::string bytes;
    std::array<char, 1U << 16U> buffer;
    for (;;) {
        const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file.get());
        if (bytes.size() + n > limit)
            return diag::Failure{
                code, fmt::format("is larger than {} bytes, the most that is read", limit)};
        bytes.append(buffer.data(), n);
        if (n < buffer.size()) break;
    }
    if (std::ferror(file.get()) != 0)
        return diag::Failure{code, fmt::format("cannot be read: {}", error_words(errno))};
    return bytes;
}

diag::Failure out_of_memory() {
    return {diag::Code::out_of_memory, "there is not enough memory to read it"};
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

bool is_lfs_pointer(const std::string& path) {
    constexpr std::string_view kBegin = "version https://git-lfs";
    std::string begin(kBegin.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return file && begin == kBegin;
}

std::string beside(const std::string& file, const std::string& path) {
    return (std::filesystem::path(file).parent_path() / path).lexically_normal().string();
}

std::string literal(const std::string& path) {
    std::string result;
    for (const char c : path) {
        if (std::string_view("*?[]\\").find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
    return result;
}

std::optional<std::vector<std::string>> paths_matching(const std::string& pattern) {
    glob_t found{};
    const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
    std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    ::globfree(&found);
    if (status != 0 && status != GLOB_NOMATCH) return std::nullopt;
    std::sort(paths.begin(), paths.end());
    return paths;
}

bool has_ending(const std::string& path, const std::vector<std::string>& endings) {
    std::string small = path;
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::any_of(endings.begin(), endings.end(),
                       [&](const std::string& ending) { return small.ends_with(ending); });
}

bool is_image(const std::string& path) {
    return has_ending(path, kImageEndings);
}

std::string image_endings() {
    return diag::alternatives(kImageEndings);
}

diag::Result<std::vector<std::string>> find_images(const std::string& folder,
                                                   const std::string& path) {
    const std::string prefix =
        folder.empty() || std::filesystem::path(path).is_absolute() ? "" : folder + "/";
    const std::string whole = prefix + path;
    std::error_code error;
    std::vector<std::string> images;
    if (std::filesystem::is_directory(whole, error)) {
        const std::string separator = path.empty() || path.ends_with('/') ? "" : "/";
        for (const auto& entry : std::filesystem::directory_iterator(whole, error))
            if (is_image(entry.path().string()))
                images.push_back(path + separator + entry.path().filename().string());
    } else if (!why_unreadable(whole)) {
        if (!is_image(path))
            return diag::Failure{
                diag::Code::unreadable_image,
                fmt::format("unknown kind of image, expected {}", image_endings())};
        images.push_back(path);
    } else {
        const auto matches = paths_matching(literal(prefix) + path);
        for (const std::string& match : matches.value_or(std::vector<std::string>{}))
            if (is_image(match)) images.push_back(match.substr(prefix.size()));
    }
    std::sort(images.begin(), images.end());
    if (images.empty())
        return diag::Failure{
            diag::Code::unreadable_image,
            fmt::format("no such image, folder of images or pattern of some, expected "
                        "files that end in {}",
                        image_endings())};
    return images;
}

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor() {
    if (number_ >= 0) ::close(number_);
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n =
            uninterrupted([&] { return ::write(descriptor, bytes.data(), bytes.size()); });
        if (n == 0) errno = EIO;
        if (n <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

bool read_all_at(int descriptor, std::uint64_t at, char* to, std::size_t n) {
    while (n > 0) {
        const ssize_t got =
            uninterrupted([&] { return ::pread(descriptor, to, n, static_cast<off_t>(at)); });
        if (got == 0) errno = EIO;
        if (got <= 0) return false;
        at += static_cast<std::uint64_t>(got);
        to += got;
        n -= static_cast<std::size_t>(got);
    }
    return true;
}

namespace {

class FileBytes final : public ByteSource {
public:
    explicit FileBytes(std::FILE* file) : file_(file) {
        struct stat status {};
        if (::fstat(::fileno(file), &status) == 0 && S_ISREG(status.st_mode))
            size_ = static_cast<std::uint64_t>(status.st_size);
    }
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;
    ~FileBytes() override { std::fclose(file_); }

    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        const std::size_t got = std::fread(to, 1, n, file_);
        if (got < n && std::ferror(file_) != 0)
            return diag::Failure{diag::Code::unreadable_data_file,
                                 fmt::format("cannot be read: {}", std::strerror(errno))};
        return got;
    }
    std::uint64_t size() const override { return size_; }

private:
    std::FILE* file_;
    std::uint64_t size_ = 0;
};

class StandardInput final : public ByteSource {
public:
    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        const auto got = uninterrupted([&] { return ::read(STDIN_FILENO, to, n); });
        if (got < 0)
            return diag::Failure{diag::Code::unreadable_data_file,
                                 fmt::format("cannot be read: {}", std::strerror(errno))};
        return static_cast<std::size_t>(got);
    }
    std::uint64_t size() const override { return 0; }
};

class MemoryBytes final : public ByteSource {
public:
    explicit MemoryBytes(std::string_view bytes) : rest_(bytes), size_(bytes.size()) {}

    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        n = std::min(n, rest_.size());
        if (n > 0) std::memcpy(to, rest_.data(), n);
        rest_.remove_prefix(n);
        return n;
    }
    std::uint64_t size() const override { return size_; }

private:
    std::string_view rest_;
    std::uint64_t size_;
};

}  // namespace

std::unique_ptr<ByteSource> standard_input() {
    return std::make_unique<StandardInput>();
}

diag::Result<std::unique_ptr<ByteSource>> open_file(const std::string& path, Streams streams) {
    if (auto why = why_unreadable(path, streams))
        return diag::Failure{diag::Code::unreadable_data_file, *why};
    std::FILE* file = std::fopen(path.c_str(), "rbe");
    if (file == nullptr)
        return diag::Failure{diag::Code::unreadable_data_file,
                             fmt::format("cannot be read: {}", std::strerror(errno))};
    return std::unique_ptr<ByteSource>(std::make_unique<FileBytes>(file));
}

std::unique_ptr<ByteSource> from_memory(std::string_view bytes) {
    return std::make_unique<MemoryBytes>(bytes);
}

}  // namespace etlc::data
