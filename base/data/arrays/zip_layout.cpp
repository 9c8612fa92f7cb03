#include "data/arrays/zip_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

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

Failure damaged(std::string message) {
    return {Code::malformed_archive, std::move(message)};
}

Failure no_archive() {
    return damaged("is no .npz file: not a zip archive");
}

Failure damaged() {
    return damaged("archive is damaged: its directory makes no sense");
}

Failure not_one_archive(std::string_view where) {
    return damaged(fmt::format("has bytes {}, expected one archive and nothing else", where));
}

/// Returns the little-endian number of `n` bytes at `at`, which must exist.
std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t n) {
    std::uint64_t value = 0;
    for (std::size_t i = n; i-- > 0;)
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

class Layout {
public:
    Layout(std::uint64_t size, const ReadAt& read) : size_(size), read_(read) {}

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
            return damaged("has a directory that is too large");
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
            return damaged(fmt::format("has a member that is {} in one place and {} in another",
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
        if (!read_(at, bytes.data(), bytes.size())) return {};
        return bytes;
    }

    static Failure unreadable() { return {Code::unreadable_data_file, "cannot be read"}; }

    std::uint64_t size_;
    const ReadAt& read_;
    std::uint64_t entries_ = 0;
    std::uint64_t directory_ = 0;  ///< its offset
    std::uint64_t directory_bytes_ = 0;
    std::uint64_t directory_end_ = 0;  ///< offset of what follows it
    std::vector<ZipMember> members_;
};

}  // namespace

diag::Result<std::vector<ZipMember>> read_zip_layout(std::uint64_t size, const ReadAt& read) {
    return Layout(size, read).members();
}

}  // namespace etlc::data
