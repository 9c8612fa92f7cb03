#include "data/arrays/archive.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <optional>

#include "data/arrays/array.hpp"
#include "data/arrays/zip_layout.hpp"
#include "data/files/descriptor.hpp"
#include "data/files/file.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

constexpr std::string_view kEnding = ".npy";
constexpr std::size_t kCandidates =
    1000;  ///< for a suggested name: an edit distance is computed to each

Failure malformed(std::string message) {
    return {Code::malformed_archive, std::move(message)};
}

/// Describes an error code of libzip.
std::string words(int code) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    std::string result = zip_error_strerror(&error);
    zip_error_fini(&error);
    const auto capital = [](char c) { return c >= 'A' && c <= 'Z'; };
    const bool abbreviation = result.size() > 1 && capital(result[1]);  // CRC
    if (!result.empty() && capital(result[0]) && !abbreviation)
        result[0] = static_cast<char>(result[0] - 'A' + 'a');
    return result;
}

Failure damaged(int code) {
    if (code == ZIP_ER_MEMORY) throw std::bad_alloc();
    if (code == ZIP_ER_NOZIP) return malformed("is no .npz file: not a zip archive");
    return malformed(fmt::format("archive is damaged: {}", words(code)));
}

/// A member that is being unpacked; it keeps its archive open.
class Member final : public ByteSource {
public:
    Member(std::shared_ptr<zip> archive, zip_file_t* file, std::uint64_t size)
        : archive_(std::move(archive)), file_(file), size_(size) {}
    Member(const Member&) = delete;
    Member& operator=(const Member&) = delete;
    ~Member() override { zip_fclose(file_); }

    diag::Result<std::size_t> read(char* to, std::size_t n) override {
        std::size_t got = 0;
        while (got < n) {
            const zip_int64_t more = zip_fread(file_, to + got, n - got);
            if (more < 0) return damaged(zip_error_code_zip(zip_file_get_error(file_)));
            if (more == 0) break;
            got += static_cast<std::size_t>(more);
        }
        return got;
    }
    std::uint64_t size() const override { return size_; }

private:
    std::shared_ptr<zip> archive_;
    zip_file_t* file_;
    std::uint64_t size_;
};

zip_t* open_file_archive(const std::string& path, int& code) {
    return zip_open(path.c_str(), ZIP_RDONLY, &code);
}

zip_t* open_memory_archive(std::string_view bytes, int& code) {
    zip_error_t error;
    zip_error_init(&error);
    zip_t* handle = nullptr;
    if (zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error)) {
        handle = zip_open_from_source(source, ZIP_RDONLY, &error);
        if (handle == nullptr) zip_source_free(source);
    }
    code = zip_error_code_zip(&error);
    zip_error_fini(&error);
    return handle;
}

diag::Result<std::vector<ZipMember>> layout_of(std::string_view bytes) {
    return read_zip_layout(bytes.size(), [&](std::uint64_t at, char* to, std::size_t n) {
        return at <= bytes.size() && bytes.substr(at).copy(to, n) == n;
    });
}

diag::Result<std::vector<ZipMember>> layout_of(const std::string& path) {
    if (auto why = why_unreadable(path)) return Failure{Code::unreadable_data_file, *why};
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (!file || ::fstat(*file, &status) != 0)
        return Failure{Code::unreadable_data_file,
                       fmt::format("cannot be read: {}", error_words(errno))};
    return read_zip_layout(
        static_cast<std::uint64_t>(status.st_size),
        [&](std::uint64_t at, char* to, std::size_t n) { return read_all_at(*file, at, to, n); });
}

/// Returns whether libzip, which has its own rules for the end of an archive, finds these members.
bool holds(zip_t* archive, const std::vector<ZipMember>& members) {
    if (zip_get_num_entries(archive, 0) != static_cast<zip_int64_t>(members.size())) return false;
    for (std::size_t i = 0; i < members.size(); ++i) {
        zip_stat_t status;
        const char* const name = zip_get_name(archive, i, ZIP_FL_ENC_RAW);
        if (name == nullptr || name != members[i].name ||
            zip_stat_index(archive, i, 0, &status) != 0)
            return false;
        if (status.crc != members[i].crc || status.comp_size != members[i].packed_bytes)
            return false;
    }
    return true;
}

std::optional<Failure> check_method(const zip_stat_t& status) {
    if (status.encryption_method != ZIP_EM_NONE)
        return malformed("is encrypted, expected plain members");
    if (status.comp_method != ZIP_CM_STORE && status.comp_method != ZIP_CM_DEFLATE)
        return malformed(fmt::format(
            "is packed by zip method {}, expected 0 (stored) or 8 (deflated)", status.comp_method));
    return {};
}

}  // namespace

Archive::Archive(std::shared_ptr<zip> handle) : handle_(std::move(handle)) {
    const zip_int64_t n = zip_get_num_entries(handle_.get(), 0);
    for (zip_int64_t i = 0; i < n; ++i) {
        const auto index = static_cast<zip_uint64_t>(i);
        const char* name = zip_get_name(handle_.get(), index, 0);
        if (name == nullptr || !std::string_view(name).ends_with(kEnding)) continue;
        const std::string_view all = name;
        keys_.emplace_back(all.substr(0, all.size() - kEnding.size()));
        indices_.push_back(index);
    }
}

diag::Result<Archive> Archive::open(const ArchivePlace& place) {
    const auto layout = place.in_memory ? layout_of(place.bytes) : layout_of(place.path);
    if (!layout) return layout.failure();
    int code = ZIP_ER_OK;
    zip_t* opened = place.in_memory ? open_memory_archive(place.bytes, code)
                                    : open_file_archive(place.path, code);
    if (opened == nullptr) return damaged(code);
    std::shared_ptr<zip> handle(opened, zip_discard);
    if (!holds(opened, *layout)) return malformed("archive can be read in two ways");
    return Archive(std::move(handle));
}

Failure Archive::missing(const std::string& key) const {
    if (keys_.empty())
        return {Code::no_such_array, fmt::format("holds no arrays, expected {}", in_quotes(key))};
    const std::string whole = key.substr(0, key.rfind('['));
    if (key.ends_with(']') && std::find(keys_.begin(), keys_.end(), whole) != keys_.end())
        return {Code::no_such_array,
                fmt::format("has no array {}, but {}, of which no single elements are taken: save "
                            "the element as a separate array",
                            in_quotes(key), in_quotes(whole))};
    std::string message =
        fmt::format("has no array {}; it holds {}", in_quotes(key), listed(keys_));
    std::vector<std::string> candidates = keys_;
    candidates.resize(std::min(candidates.size(), kCandidates));
    message += suggestion(key, candidates);
    return {Code::no_such_array, message};
}

diag::Result<std::unique_ptr<ByteSource>> Archive::member(const std::string& key) const {
    const auto found = std::find(keys_.begin(), keys_.end(), key);
    if (found == keys_.end()) return missing(key);
    if (std::find(found + 1, keys_.end(), key) != keys_.end())
        return Failure{Code::malformed_archive,
                       fmt::format("holds two arrays named {}", in_quotes(key))};
    const std::uint64_t index = indices_[static_cast<std::size_t>(found - keys_.begin())];
    auto member = open_member(index);
    if (!member) return in_array(member.failure(), key);
    return member;
}

bool Archive::has_file(const std::string& name) const {
    return zip_name_locate(handle_.get(), name.c_str(), ZIP_FL_ENC_RAW) >= 0;
}

diag::Result<std::unique_ptr<ByteSource>> Archive::file(const std::string& name,
                                                        std::uint64_t limit) const {
    const zip_int64_t index = zip_name_locate(handle_.get(), name.c_str(), ZIP_FL_ENC_RAW);
    if (index < 0)
        return Failure{Code::no_such_array, fmt::format("has no member {}", in_quotes(name))};
    auto member = open_member(static_cast<std::uint64_t>(index));
    if (member && (*member)->size() > limit)
        return malformed(fmt::format("member {} takes {} bytes, at most {} are read",
                                     in_quotes(name), (*member)->size(), limit));
    return member;
}

diag::Result<std::unique_ptr<ByteSource>> Archive::open_member(std::uint64_t index) const {
    zip_stat_t status;
    if (zip_stat_index(handle_.get(), index, 0, &status) != 0)
        return damaged(zip_error_code_zip(zip_get_error(handle_.get())));
    if (auto failure = check_method(status)) return *failure;
    zip_file_t* file = zip_fopen_index(handle_.get(), index, 0);
    if (file == nullptr) return damaged(zip_error_code_zip(zip_get_error(handle_.get())));
    return std::unique_ptr<ByteSource>(std::make_unique<Member>(handle_, file, status.size));
}

}  // namespace etlc::data
