// Reads and writes the files that etlc's commands exchange: thresholds, which are JSON, and
// archives of arrays with a JSON member that describes them. Faults of the text come before those
// of its content, and limits hold before memory is spent.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artifacts/reader.hpp"
#include "artifacts/writer.hpp"
#include "data/arrays/archive.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"

namespace etlc::artifacts {

/// Larger files are refused. Millions of episodes take less, and temporary files take as much.
inline constexpr std::uint64_t kMaxFileBytes = 4ULL << 30U;
/// Limits on the text and the JSON values that are kept in memory, which excludes "recordings" and
/// the items of arrays of episodes and scores.
inline constexpr std::uint64_t kMaxKeptBytes = 64ULL << 20U;
inline constexpr std::uint64_t kMaxValues = 1ULL << 21U;

/// Reads the root object, or throws a fault.
using ReadRoot = std::function<void(Reader& root)>;

/// Read a JSON file, or the description in an archive. Return the failure, if any.
std::optional<diag::Failure> read_text(const Kind& kind, data::ByteSource& source,
                                       const ReadRoot& read_root);
std::optional<diag::Failure> read_description(const Kind& kind, const data::Archive& archive,
                                              const ReadRoot& read_root);

/// Describes the member "allowances".
template <class Archive>
void allowance_members(Archive& archive, auto& allowances) {
    archive(
        "allowances", allowances, "an array",
        [](auto& one, auto& allowance) {
            one("reason", allowance.reason);
            one("overlapping", allowance.overlapping);
            one("leaked", allowance.leaked);
        },
        Presence::where_any);
}

/// Describes the groups in a file of thresholds or of fitted things, and checks them where it
/// reads.
template <class Archive>
void group_members(Archive& archive, auto& groups) {
    archive("groups", groups, Presence::where_any);
    if constexpr (Archive::kReads)
        for (const auto& [hash, name] : groups) {
            if (!data::hash_of_text(hash))
                archive.refuse(fmt::format("key {} is no content hash of 16 hex digits",
                                           data::in_quotes("groups." + hash)));
            if (name.empty())
                archive.refuse(fmt::format("{} is empty, expected the name of a group",
                                           data::in_quotes("groups." + hash)));
        }
}

/// Reads an archive whose description `members(archive, file)` describes.
template <class File, class Members>
diag::Result<File> read_archive(const Kind& kind, const std::string& path, const Members& members) {
    const auto archive = data::Archive::open(path);
    if (!archive) return archive.failure();
    File file;
    file.path = path;
    const auto failure = read_description(kind, *archive, [&](Reader& root) {
        root.read_file([&](auto& description) { members(description, file); });
    });
    if (failure) return *failure;
    return file;
}

/// Returns the bytes of such an archive.
template <class File, class Members>
std::string archive_bytes(const Kind& kind, const File& file, const Members& members) {
    std::vector<data::ArchiveMember> arrays(1);
    std::string description =
        file_text(kind.format, &arrays, [&](auto& archive) { members(archive, file); });
    arrays.front() = {kind.member, std::move(description)};
    return data::npz_bytes(arrays);
}

/// Replaces the ending of SPEC.etl with another, such as ".fitted.npz".
std::string path_beside(const std::string& spec_path, std::string_view ending);

}  // namespace etlc::artifacts
