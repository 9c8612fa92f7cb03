#include "annotate/copy.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/parquet/footer.hpp"

namespace etlc::annotate {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;

namespace {

Failure unwritable(const fs::path& path, int error) {
    return {Code::unwritable_output,
            fmt::format("{} cannot be written: {}", data::in_quotes(path.string()),
                        data::error_words(error))};
}

/// Names the copy while it is incomplete. A call that is killed leaves it; the next one for the
/// same folder clears it.
std::string part_of(const fs::path& folder) {
    return (folder.parent_path() / fmt::format(".{}.etlc-part", folder.filename().string()))
        .string();
}

/// Follows links to the folder in which a new one will be, and removes the slash at the end.
fs::path plain(const std::string& path) {
    const fs::path normal = fs::absolute(path).lexically_normal();
    const fs::path name = normal.has_filename() ? normal : normal.parent_path();
    std::error_code unknown;  // a folder that is not there cannot be written to, which is said then
    const fs::path parent = fs::canonical(name.parent_path(), unknown);
    return unknown ? name : parent / name.filename();
}

/// A Parquet file, open to be read.
struct Extended {
    data::Descriptor file;
    std::uint64_t kept = 0;  ///< the bytes before its footer
    std::string footer;
};

diag::Result<Extended> open_parquet(const std::string& path) {
    const Failure changed{Code::unreadable_parquet, "has changed while it was read"};
    Extended opened;
    opened.file = data::Descriptor(
        data::uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }));
    struct stat status {};
    if (!opened.file || ::fstat(*opened.file, &status) != 0)
        return Failure{Code::unreadable_parquet, data::error_words(errno)};
    const auto size = static_cast<std::uint64_t>(status.st_size);
    char tail[8] = {};
    std::uint32_t length = 0;
    if (size < 12 || !data::read_all_at(*opened.file, size - 8, tail, 8)) return changed;
    std::memcpy(&length, tail, sizeof length);
    if (length > std::min<std::uint64_t>(size - 12, recordings::parquet::kMaxFooterBytes))
        return changed;
    opened.kept = size - 8 - length;
    opened.footer.resize(length);
    if (!data::read_all_at(*opened.file, opened.kept, opened.footer.data(), length)) return changed;
    return opened;
}

/// Copies the first bytes of a file.
std::optional<Failure> copy(const Extended& from, data::AtomicFile& to) {
    constexpr std::uint64_t kBlock = 1U << 20U;
    std::string block;
    for (std::uint64_t at = 0; at < from.kept; at += block.size()) {
        block.resize(std::min(from.kept - at, kBlock));
        if (!data::read_all_at(*from.file, at, block.data(), block.size()))
            return Failure{Code::unreadable_parquet, data::error_words(errno)};
        if (auto failure = to.write(block)) return failure;
    }
    return std::nullopt;
}

}  // namespace

DatasetCopy::DatasetCopy(std::string from, std::string to, std::set<std::string> changed)
    : from_(fs::canonical(from).string()),
      to_(to.empty() ? from_ : plain(to).string()),
      part_(part_of(to_)),
      changed_(std::move(changed)),
      replaces_(to.empty()) {}

DatasetCopy::~DatasetCopy() {
    std::error_code error;
    if (lock_) fs::remove_all(part_, error);
}

std::optional<Failure> DatasetCopy::begin() {
    if (!replaces_ && fs::exists(fs::symlink_status(to_)))
        return Failure{Code::unwritable_output, "exists: the new data set needs a new folder"};
    if (!replaces_ && to_.starts_with(from_ + "/"))
        return Failure{Code::unwritable_output, "lies in the data set of which it is a copy"};
    fs::create_directory(part_);
    constexpr int kNoLink = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
    data::Descriptor folder(data::uninterrupted([&] { return ::open(part_.c_str(), kNoLink); }));
    struct stat status {};
    if (!folder || ::fstat(*folder, &status) != 0) return unwritable(part_, errno);
    if (status.st_uid != ::geteuid()) return unwritable(part_, EEXIST);
    if (::flock(*folder, LOCK_EX | LOCK_NB) != 0)
        return Failure{Code::unwritable_output, "is being written by another call"};
    lock_ = std::move(folder);
    for (const fs::directory_entry& left_over : fs::directory_iterator(part_))
        fs::remove_all(left_over.path());
    return std::nullopt;
}

/// Throws fs::filesystem_error.
void DatasetCopy::take(const std::string& file, const std::string& from) {
    const fs::path top = *fs::path(file).begin();
    if (replaces_ || top == "videos" || top == "images") {
        std::error_code error;
        fs::create_hard_link(fs::canonical(from), path_of(file), error);
        if (!error) return static_cast<void>(++linked_);
    }
    fs::copy_file(from, path_of(file));
    ++copied_;
}

std::optional<Failure> DatasetCopy::fill() {
    try {
        if (auto failure = begin()) return failure;
        fs::recursive_directory_iterator it(from_);
        for (const fs::recursive_directory_iterator end; it != end; ++it) {
            const std::string from = it->path().string();
            const std::string file = from.substr(from_.size() + 1);
            const bool is_hidden = it.depth() == 0 && (file == ".git" || file == ".cache");
            if (it->is_symlink() && !it->is_regular_file()) {
                fs::copy_symlink(from, path_of(file));
            } else if (it->is_directory()) {
                if (is_hidden && !replaces_)
                    it.disable_recursion_pending();
                else
                    fs::create_directory(path_of(file));
            } else if (it->is_regular_file() && !changed_.contains(file)) {
                take(file, from);
            }
        }
    } catch (const fs::filesystem_error& error) {
        return unwritable(error.path1(), error.code().value());
    }
    return std::nullopt;
}

std::optional<Failure> DatasetCopy::extend(const std::string& file,
                                           const std::vector<NewColumn>& columns) {
    const auto from = open_parquet(from_ + "/" + file);
    if (!from) return from.failure();
    try {
        const std::string rest = extension(from->footer, from->kept, columns);
        auto to = data::AtomicFile::create(path_of(file), Code::unwritable_output);
        if (!to) return to.failure();
        if (auto failure = copy(*from, *to)) return failure;
        if (auto failure = to->write(rest)) return failure;
        return to->commit();
    } catch (const recordings::parquet::Refused& refused) {
        return Failure{Code::unreadable_parquet, refused.what()};
    }
}

std::optional<Failure> DatasetCopy::write(const std::string& file, const std::string& bytes) {
    return data::write_file_atomically(path_of(file), bytes, Code::unwritable_output);
}

std::optional<Failure> DatasetCopy::commit() {
    if (!replaces_)
        return std::rename(part_.c_str(), to_.c_str()) == 0 ? std::nullopt
                                                            : std::optional(unwritable(to_, errno));
    // The destructor removes the old files.
    if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, to_.c_str(), RENAME_EXCHANGE) == 0)
        return std::nullopt;
    if (errno != EINVAL && errno != ENOSYS) return unwritable(to_, errno);
    return Failure{Code::unwritable_output,
                   "cannot be replaced on its file system, which cannot exchange the names of two "
                   "folders: write a copy with -o"};
}

}  // namespace etlc::annotate
