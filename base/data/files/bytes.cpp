#include "data/files/bytes.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "data/files/descriptor.hpp"
#include "data/files/file.hpp"

namespace etlc::data {
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
