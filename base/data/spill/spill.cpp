#include "data/spill/spill.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "data/files/file.hpp"

namespace etlc::data {

namespace {

std::string folder() {
    const char* const given = std::getenv("TMPDIR");
    return given == nullptr || *given == '\0' ? "/tmp" : given;
}

[[noreturn]] void fail(const char* what) {
    const std::string why = error_words(errno);
    throw SpillError(
        fmt::format("a temporary file in {} cannot be {}: {}; TMPDIR names another "
                    "folder",
                    folder(), what, why));
}

Descriptor make_nameless_file() {
    const std::string in = folder();
    Descriptor file(uninterrupted(
        [&] { return ::open(in.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR); }));
    if (file) return file;
    std::string name = in + "/etlc-XXXXXX";  // of a file system that has no nameless files
    Descriptor named(uninterrupted([&] { return ::mkostemp(name.data(), O_CLOEXEC); }));
    if (!named) fail("made");
    ::unlink(name.c_str());
    return named;
}

}  // namespace

std::uint64_t SpillFile::append(std::string_view bytes) {
    const std::uint64_t at = size();
    if (last_.size() + bytes.size() > kInMemory) store();
    last_ += bytes;
    return at;
}

void SpillFile::store() {
    if (!file_) file_ = make_nameless_file();
    if (!write_all(*file_, last_)) fail("written");
    stored_ += last_.size();
    last_.clear();
}

void SpillFile::read(std::uint64_t at, char* to, std::size_t n) const {
    if (at < stored_) {
        const auto there = static_cast<std::size_t>(std::min<std::uint64_t>(n, stored_ - at));
        if (!read_all_at(*file_, at, to, there)) fail("read");
        at += there;
        to += there;
        n -= there;
    }
    if (n > 0) std::memcpy(to, last_.data() + (at - stored_), n);
}

}  // namespace etlc::data
