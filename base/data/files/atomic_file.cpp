#include "data/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <filesystem>
#include <utility>

#include "data/files/file.hpp"

namespace etlc::data {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kMostNames = 1000;  ///< temporary names that are tried
constexpr int kMostLinks = 40;         ///< longest chain of symbolic links, as in Linux
constexpr int kMostTurns = 200;  ///< a commit waits so often for others, kTurnMicroseconds each
constexpr unsigned kTurnMicroseconds = 5000;

/// Follows symbolic links to a file, which need not exist; returns an empty path for a loop.
fs::path behind_links(fs::path path) {
    for (int i = 0; i < kMostLinks; ++i) {
        std::string target(PATH_MAX, '\0');
        const ssize_t size = ::readlink(path.c_str(), target.data(), target.size());
        if (size < 0) return path;
        target.resize(static_cast<std::size_t>(size));
        path = path.parent_path() / target;
    }
    return {};
}

std::string temporary_name(unsigned number) {
    return fmt::format(".etlc-{}-{}.part", ::getpid(), number);
}

/// Returns whether a path ends in "/", "." or "..", so that it cannot name a file.
bool names_no_file(const fs::path& path) {
    return !path.has_filename() || path.filename() == "." || path.filename() == "..";
}

/// A lock on a folder while files take their names in it.
class Turn {
public:
    /// Waits for a second at most.
    explicit Turn(int folder)
        : folder_(uninterrupted(
              [&] { return ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC); })) {
        for (int i = 0; folder_ && i < kMostTurns; ++i) {
            is_others_ = ::flock(*folder_, LOCK_EX | LOCK_NB) != 0 &&
                         (errno == EWOULDBLOCK || errno == EINTR);
            if (!is_others_) return;
            ::usleep(kTurnMicroseconds);
        }
    }

    /// Returns whether another process has the lock; false too where there are no locks.
    bool is_others() const { return is_others_; }

private:
    Descriptor folder_;
    bool is_others_ = false;
};

}  // namespace

AtomicFile::AtomicFile(std::string name, Descriptor folder, Descriptor file, diag::Code code)
    : name_(std::move(name)), folder_(std::move(folder)), file_(std::move(file)), code_(code) {}

AtomicFile::~AtomicFile() {
    if (folder_ && !temporary_.empty()) ::unlinkat(*folder_, temporary_.c_str(), 0);
}

diag::Result<AtomicFile> AtomicFile::create(const std::string& path, diag::Code code) {
    const auto refuse = [&](int error) {
        // Writing does not need the file to exist, so ENOENT is about its folder.
        const bool no_folder = error == ENOENT || error == ENOTDIR;
        return diag::Failure{code, fmt::format("cannot be written: {}",
                                               no_folder ? "no such folder" : error_words(error))};
    };
    const auto directly = [&](int descriptor) -> diag::Result<AtomicFile> {
        if (descriptor < 0) return refuse(errno);
        return AtomicFile({}, Descriptor(), Descriptor(descriptor), code);
    };
    // These are written in place: others may write to the same file.
    if (path == "/dev/stdout")
        return directly(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    if (path == "/dev/stderr")
        return directly(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) return refuse(EISDIR);
    if (exists && !S_ISREG(status.st_mode))
        return directly(uninterrupted([&] { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }));
    if (exists && ::access(path.c_str(), W_OK) != 0) return refuse(errno);

    const fs::path target = behind_links(path);
    if (target.empty()) return refuse(ELOOP);
    if (names_no_file(target)) return refuse(ENOENT);
    const fs::path parent = target.has_parent_path() ? target.parent_path() : fs::path(".");
    Descriptor folder(
        uninterrupted([&] { return ::open(parent.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC); }));
    if (!folder) return refuse(errno);
    AtomicFile file(target.filename().string(), std::move(folder), Descriptor(), code);
    if (!file.open_temporary(exists ? 0600 : 0666)) return refuse(errno);
    if (exists) file.copy_permissions(status);
    return file;
}

/// Calls `create(name)` with temporary names until it succeeds; false, with errno, where it cannot.
template <class Create>
bool AtomicFile::take_temporary_name(const Create& create) {
    for (unsigned i = 0; i < kMostNames; ++i) {
        std::string name = temporary_name(i);
        if (create(name.c_str())) {
            temporary_ = std::move(name);
            return true;
        }
        if (errno != EEXIST) return false;
    }
    return false;
}

bool AtomicFile::open_temporary(mode_t mode) {
    const auto open = [&](const char* name, int flags) {
        return uninterrupted(
            [&] { return ::openat(*folder_, name, O_WRONLY | O_CLOEXEC | flags, mode); });
    };
    // A nameless file gets its name through /proc.
    if (::access("/proc/self/fd", X_OK) == 0) file_ = Descriptor(open(".", O_TMPFILE));
    return file_ || take_temporary_name([&](const char* name) {
               file_ = Descriptor(open(name, O_CREAT | O_EXCL));
               return static_cast<bool>(file_);
           });
}

void AtomicFile::copy_permissions(const struct stat& of) {
    mode_t mode = of.st_mode & 0777;
    // Where the group cannot be kept, the new group gets the permissions of everybody.
    if (::fchown(*file_, of.st_uid, of.st_gid) != 0 &&
        ::fchown(*file_, static_cast<uid_t>(-1), of.st_gid) != 0)
        mode &= ~static_cast<mode_t>(S_IRWXG) | (mode & S_IRWXO) << 3U;
    static_cast<void>(
        ::fchmod(*file_, mode));  // it stays 0600: less than what was there may, never more
}

std::optional<diag::Failure> AtomicFile::failed(int error) const {
    return diag::Failure{code_, fmt::format("cannot be written: {}", error_words(error))};
}

std::optional<diag::Failure> AtomicFile::write(std::string_view bytes) {
    if (!write_all(*file_, bytes)) return failed(errno);
    return {};
}

std::optional<diag::Failure> AtomicFile::finish() {
    const int copy = ::fcntl(*file_, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (copy < 0 || ::close(copy) != 0) return failed(errno);
    return {};
}

std::optional<diag::Failure> AtomicFile::sync() {
    if (uninterrupted([&] { return ::fsync(*file_); }) != 0) return failed(errno);
    return {};
}

std::optional<diag::Failure> AtomicFile::name() {
    if (is_direct() || !temporary_.empty()) return {};
    const std::string nameless = fmt::format("/proc/self/fd/{}", *file_);
    const bool named = take_temporary_name([&](const char* name) {
        return ::linkat(AT_FDCWD, nameless.c_str(), *folder_, name, AT_SYMLINK_FOLLOW) == 0;
    });
    if (!named) return failed(errno);
    return {};
}

std::optional<diag::Failure> AtomicFile::place() {
    if (is_direct()) return {};
    if (::renameat(*folder_, temporary_.c_str(), *folder_, name_.c_str()) != 0)
        return failed(errno);
    temporary_.clear();
    return {};
}

std::optional<diag::Failure> AtomicFile::commit(const StillRight& is_right) {
    if (auto uncommitted = commit_all({this}, is_right)) return uncommitted->failure;
    return {};
}

std::optional<Uncommitted> commit_all(const std::vector<AtomicFile*>& files,
                                      const StillRight& is_right) {
    const auto all = [&](auto step) -> std::optional<Uncommitted> {
        for (std::size_t n = 0; n < files.size(); ++n)
            if (auto failure = (files[n]->*step)()) return Uncommitted{n, *failure};
        return {};
    };
    if (auto uncommitted = all(&AtomicFile::finish)) return uncommitted;
    int folder = -1;
    for (const AtomicFile* file : files)
        if (file->folder_) folder = *file->folder_;
    const Turn turn(folder);
    // Without the lock the files of two calls may mix, no more; but what was read may be gone.
    if (is_right && turn.is_others())
        return Uncommitted{
            0,
            {files[0]->code_, "cannot be written: another program has locked its folder (flock)"}};
    if (auto why = is_right ? is_right() : std::nullopt) return Uncommitted{0, *why};
    if (auto uncommitted = all(&AtomicFile::name)) return uncommitted;
    return all(&AtomicFile::place);
}

std::optional<diag::Failure> write_file_atomically(const std::string& path, std::string_view bytes,
                                                   diag::Code code, const StillRight& is_right) {
    auto file = AtomicFile::create(path, code);
    if (!file) return file.failure();
    if (auto failure = file->write(bytes)) return failure;
    return file->commit(is_right);
}

std::optional<diag::Failure> write_file_durably(const std::string& path, std::string_view bytes,
                                                diag::Code code, const StillRight& is_right) {
    auto file = AtomicFile::create(path, code);
    if (!file) return file.failure();
    if (auto failure = file->write(bytes)) return failure;
    if (auto failure = file->sync()) return failure;
    if (auto failure = file->commit(is_right)) return failure;
    const fs::path parent = behind_links(path).parent_path();
    const Descriptor folder(uninterrupted([&] {
        return ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    }));
    if (folder) static_cast<void>(::fsync(*folder));
    return {};
}

}  // namespace etlc::data
