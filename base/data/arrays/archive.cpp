#include "data/arrays/archive.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <memory>
#include <new>
#include <optional>
#include <string_view>

#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"

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

Failure no_archive() {
    return malformed("is no .npz file: not a zip archive");
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
    if (code == ZIP_ER_NOZIP) return no_archive();
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

constexpr std::string_view kLocal = "PK\x03\x04";
constexpr std::string_view kEntry = "PK\x01\x02";
constexpr std::string_view kEnd = "PK\x05\x06";
constexpr std::string_view kEnd64 = "PK\x06\x06";
constexpr std::string_view kLocator64 = "PK\x06\x07";
constexpr std::size_t kLocalBytes = 30;
constexpr std::size_t kEntryBytes = 46;
constexpr std::size_t kEndBytes = 22;
constexpr std::size_t kEnd64Bytes = 56;
constexpr std::size_t kLocatorBytes = 20;
constexpr std::size_t kMostComment = 0xffff;
constexpr std::uint64_t kMostDirectoryBytes = 64U << 20U;  ///< enough for half a million members
constexpr std::uint64_t kIn64 =
    0xffffffff;  ///< marks a 32-bit field whose value is stored elsewhere, in 64 bits
constexpr std::uint64_t kCountIn64 = 0xffff;

Failure damaged() {
    return malformed("archive is damaged: its directory makes no sense");
}

Failure not_one_archive(std::string_view where) {
    return malformed(fmt::format("has bytes {}, expected one archive and nothing else", where));
}

/// Returns the little-endian number of `n` bytes at `at`, which must exist.
std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t n) {
    std::uint64_t value = 0;
    for (std::size_t i = n; i-- > 0;)
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

/// An entry of the directory of a zip archive.
struct ZipMember {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t packed_bytes = 0;
    std::uint64_t offset = 0;   ///< of its header
    bool sizes_follow = false;  ///< its header was written before its size was known
};

/// The layout of an archive, restricted to what all readers read alike: the members begin at the
/// file's first byte and follow each other without a gap, then the directory, then the record that
/// ends the file. So there is no second archive before, after or between them, which another reader
/// might take for the archive. Source: PKWARE, APPNOTE.TXT 6.3.10, section 4.3.
class Layout {
public:
    Layout(const Descriptor& file, std::uint64_t size) : file_(file), size_(size) {}

    /// Returns the entries of the directory, in its order.
    diag::Result<std::vector<ZipMember>> members() {
        if (auto failure = find_directory()) return *failure;
        if (auto failure = read_directory()) return *failure;
        if (auto failure = check_places()) return *failure;
        return std::move(members_);
    }

private:
    /// Finds the directory by the record at the end of the file, which nothing may follow.
    std::optional<Failure> find_directory() {
        if (size_ < kEndBytes) return no_archive();
        const std::uint64_t searched = std::min<std::uint64_t>(size_, kEndBytes + kMostComment);
        const auto tail = read(size_ - searched, searched);
        if (!tail) return unreadable();
        const std::size_t at = tail->rfind(kEnd);
        if (at == std::string::npos) return no_archive();
        const std::uint64_t end = size_ - searched + at;
        if (searched - at < kEndBytes) return not_one_archive("behind its end");
        const std::string_view record = std::string_view(*tail).substr(at);
        if (record.size() != kEndBytes + number(record, 20, 2))
            return not_one_archive("behind its end");
        if (number(record, 4, 4) != 0 || number(record, 8, 2) != number(record, 10, 2))
            return damaged();
        entries_ = number(record, 10, 2);
        directory_bytes_ = number(record, 12, 4);
        directory_ = number(record, 16, 4);
        directory_end_ = end;
        if (auto failure = find_directory64(end)) return failure;
        if (directory_ > directory_end_ || directory_bytes_ > directory_end_) return damaged();
        if (directory_bytes_ > kMostDirectoryBytes)
            return malformed("has a directory that is too large");
        if (directory_ + directory_bytes_ != directory_end_)
            return not_one_archive("around its directory");
        return {};
    }

    /// Reads the 64-bit record, which exists where a locator precedes the 32-bit one.
    std::optional<Failure> find_directory64(std::uint64_t end) {
        const bool needed =
            entries_ == kCountIn64 || directory_bytes_ == kIn64 || directory_ == kIn64;
        const auto locator =
            end < kLocatorBytes ? std::string() : read(end - kLocatorBytes, kLocatorBytes);
        if (!locator) return unreadable();
        if (!locator->starts_with(kLocator64))
            return needed ? std::optional(damaged()) : std::nullopt;
        const std::uint64_t at = number(*locator, 8, 8);
        if (at > end - kLocatorBytes || end - kLocatorBytes - at != kEnd64Bytes) return damaged();
        const auto record = read(at, kEnd64Bytes);
        if (!record) return unreadable();
        if (!record->starts_with(kEnd64) || number(*record, 4, 8) != kEnd64Bytes - 12)
            return damaged();
        const auto agrees = [&](std::uint64_t& value, std::uint64_t in64, std::uint64_t mark) {
            const bool same = value == in64 || value == mark;
            value = in64;
            return same;
        };
        const bool same = agrees(entries_, number(*record, 32, 8), kCountIn64) &&
                          agrees(directory_bytes_, number(*record, 40, 8), kIn64) &&
                          agrees(directory_, number(*record, 48, 8), kIn64);
        directory_end_ = at;
        return same ? std::nullopt : std::optional(damaged());
    }

    std::optional<Failure> read_directory() {
        const auto bytes = read(directory_, directory_bytes_);
        if (!bytes) return unreadable();
        std::string_view rest = *bytes;
        for (; entries_ > 0; --entries_) {
            if (rest.size() < kEntryBytes || !rest.starts_with(kEntry)) return damaged();
            const std::size_t name = number(rest, 28, 2);
            const std::size_t extra = number(rest, 30, 2);
            const std::size_t length = kEntryBytes + name + extra + number(rest, 32, 2);
            if (rest.size() < length) return damaged();
            ZipMember member;
            member.name = rest.substr(kEntryBytes, name);
            member.sizes_follow = (number(rest, 8, 2) & 8U) != 0;
            member.crc = static_cast<std::uint32_t>(number(rest, 16, 4));
            member.packed_bytes = number(rest, 20, 4);
            member.offset = number(rest, 42, 4);
            if (!widen(rest.substr(kEntryBytes + name, extra), number(rest, 24, 4), member))
                return damaged();
            members_.push_back(std::move(member));
            rest.remove_prefix(length);
        }
        return rest.empty() ? std::nullopt : std::optional(damaged());
    }

    /// Reads the extra field of 64-bit values, in the order unpacked, packed, offset.
    static bool widen(std::string_view extra, std::uint64_t unpacked, ZipMember& member) {
        std::string_view wide;
        while (extra.size() >= 4) {
            const std::size_t length = number(extra, 2, 2);
            if (extra.size() - 4 < length) break;  // padding of some writers
            if (number(extra, 0, 2) == 1) wide = extra.substr(4, length);
            extra.remove_prefix(4 + length);
        }
        for (std::uint64_t* value : {&unpacked, &member.packed_bytes, &member.offset}) {
            if (*value != kIn64) continue;
            if (wide.size() < 8) return false;
            *value = number(wide, 0, 8);
            wide.remove_prefix(8);
        }
        return true;
    }

    std::optional<Failure> check_places() const {
        std::vector<const ZipMember*> in_file;
        for (const ZipMember& member : members_) in_file.push_back(&member);
        std::sort(in_file.begin(), in_file.end(),
                  [](const auto* a, const auto* b) { return a->offset < b->offset; });
        if ((in_file.empty() ? directory_ : in_file[0]->offset) != 0)
            return not_one_archive("before its first member");
        for (std::size_t i = 0; i < in_file.size(); ++i)
            if (auto failure = check_place(
                    *in_file[i], i + 1 < in_file.size() ? in_file[i + 1]->offset : directory_))
                return failure;
        return {};
    }

    /// Checks that the member ends where the next one begins.
    std::optional<Failure> check_place(const ZipMember& member, std::uint64_t next) const {
        if (member.offset > next || next - member.offset < kLocalBytes) return damaged();
        const auto head = read(member.offset, kLocalBytes);
        if (!head) return unreadable();
        const std::uint64_t name = number(*head, 26, 2);
        const std::uint64_t before = kLocalBytes + name + number(*head, 28, 2);
        const std::uint64_t room = next - member.offset;
        if (!head->starts_with(kLocal) || room < before || room - before < member.packed_bytes)
            return damaged();
        const auto again = read(member.offset + kLocalBytes, name);
        if (!again) return unreadable();
        if (*again != member.name)
            return malformed(fmt::format("has a member that is {} in one place and {} in another",
                                         in_quotes(*again), in_quotes(member.name)));
        // The data are followed by their checksum and sizes, in 32 or 64 bits, perhaps signed.
        const std::uint64_t behind = room - before - member.packed_bytes;
        const bool descriptor = behind == 12 || behind == 16 || behind == 20 || behind == 24;
        if (behind != 0 && !(member.sizes_follow && descriptor))
            return not_one_archive("between its members");
        return {};
    }

    std::optional<std::string> read(std::uint64_t at, std::uint64_t n) const {
        std::string bytes(n, '\0');
        if (!read_all_at(*file_, at, bytes.data(), bytes.size())) return {};
        return bytes;
    }

    static Failure unreadable() { return {Code::unreadable_data_file, "cannot be read"}; }

    const Descriptor& file_;
    std::uint64_t size_;
    std::uint64_t entries_ = 0;
    std::uint64_t directory_ = 0;  ///< its offset
    std::uint64_t directory_bytes_ = 0;
    std::uint64_t directory_end_ = 0;  ///< offset of what follows it
    std::vector<ZipMember> members_;
};

diag::Result<std::vector<ZipMember>> layout_of(const std::string& path) {
    if (auto why = why_unreadable(path)) return Failure{Code::unreadable_data_file, *why};
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (!file || ::fstat(*file, &status) != 0)
        return Failure{Code::unreadable_data_file,
                       fmt::format("cannot be read: {}", error_words(errno))};
    return Layout(file, static_cast<std::uint64_t>(status.st_size)).members();
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

diag::Result<Archive> Archive::open(const std::string& path) {
    const auto layout = layout_of(path);
    if (!layout) return layout.failure();
    int code = ZIP_ER_OK;
    zip_t* opened = zip_open(path.c_str(), ZIP_RDONLY, &code);
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

namespace {

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_source_t* source) const { zip_source_free(source); }
};

/// Writing to memory fails only where memory runs out.
void require(bool done) {
    if (!done) throw std::bad_alloc();
}

void add(zip_t* archive, const ArchiveMember& member) {
    constexpr zip_uint16_t kFirstDay = (1U << 5U) | 1U;  // 1980-01-01, the first that zip can tell
    zip_source_t* source = zip_source_buffer(archive, member.bytes.data(), member.bytes.size(), 0);
    require(source != nullptr);
    const zip_int64_t index = zip_file_add(archive, member.name.c_str(), source, 0);
    if (index < 0) zip_source_free(source);
    require(index >= 0);
    const auto at = static_cast<zip_uint64_t>(index);
    require(zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) == 0);
    require(zip_file_set_dostime(archive, at, 0, kFirstDay, 0) == 0);
}

std::string bytes_of(zip_source_t* source) {
    zip_stat_t status;
    zip_stat_init(&status);
    require(zip_source_stat(source, &status) == 0 && zip_source_open(source) == 0);
    std::string bytes(status.size, '\0');
    const zip_int64_t got = zip_source_read(source, bytes.data(), bytes.size());
    zip_source_close(source);
    require(got == static_cast<zip_int64_t>(bytes.size()));
    return bytes;
}

/// Returns the head of a .npy file. `element`: the type code of numpy, "<f4".
std::string npy_head(std::string_view element, const std::vector<std::uint64_t>& shape) {
    constexpr std::size_t kAlignment = 64;
    constexpr std::size_t kPreamble = 10;  // magic word, version, length of the header
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}",
                                     element, shape_text(shape));
    header.append(kAlignment - (kPreamble + header.size() + 1) % kAlignment, ' ');
    header += '\n';
    std::string bytes{"\x93NUMPY\x01\x00", 8};
    bytes += static_cast<char>(header.size() & 0xffU);
    bytes += static_cast<char>(header.size() >> 8U);
    bytes += header;
    return bytes;
}

}  // namespace

std::string npy_bytes(const std::vector<std::uint64_t>& shape, const std::vector<float>& values) {
    std::string bytes = npy_head("<f4", shape);
    bytes.reserve(bytes.size() + 4 * values.size());
    for (const float value : values) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (unsigned shift = 0; shift < 32; shift += 8)
            bytes += static_cast<char>((bits >> shift) & 0xffU);
    }
    return bytes;
}

std::string npy_of_uint8(const std::vector<std::uint64_t>& shape,
                         const std::vector<std::uint8_t>& values) {
    return npy_head("|u1", shape).append(values.begin(), values.end());
}

std::string npz_bytes(const std::vector<ArchiveMember>& members) {
    zip_error_t error;
    zip_error_init(&error);
    const std::unique_ptr<zip_source_t, Discard> source(
        zip_source_buffer_create(nullptr, 0, 0, &error));
    require(source != nullptr);
    std::unique_ptr<zip_t, Discard> archive(
        zip_open_from_source(source.get(), ZIP_TRUNCATE, &error));
    require(archive != nullptr);
    zip_source_keep(source.get());  // the archive takes one hold of it, we keep ours
    for (const ArchiveMember& member : members) add(archive.get(), member);
    require(zip_close(archive.get()) == 0);
    static_cast<void>(archive.release());  // closed
    zip_error_fini(&error);
    return bytes_of(source.get());
}

}  // namespace etlc::data
