// Files that appear whole or not at all.
// Takes: a path and bytes. Gives: a file of that name with these bytes, or a Failure with the
// caller's code; its message does not repeat the path: `in_file` (data/files/file.hpp) adds it.
// Keeps true: a failed write leaves the old file, and no other. So does a process that is killed:
// until it is complete a file has no name, where the file system supports such files. Elsewhere,
// and between the two system calls that name it, a kill leaves `.etlc-PROCESS-NUMBER.part`.
// A replaced file keeps its permissions, and its owner and group where the system permits. Only
// write_file_durably waits for the disk: elsewhere a power failure loses what is not yet stored.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

/// The file that could not take its name, and the reason.
struct Uncommitted {
    std::size_t file;
    diag::Failure failure;
};

/// Says why a file must not be replaced after all, such as another content than was read. It is
/// asked when no other process of etlc can write to the folder any more: the lock is that of the
/// folder, which outlasts its files. Where the file system has no locks (flock), it is asked all
/// the same, and another process may still come between the answer and the new name.
using StillRight = std::function<std::optional<diag::Failure>()>;

/// A file that takes its own name only when it is complete. Devices, pipes, /dev/stdout and
/// /dev/stderr are written to directly. A symbolic link stays; the file that it points to is
/// created or replaced.
class AtomicFile {
public:
    static diag::Result<AtomicFile> create(const std::string& path, diag::Code code);

    AtomicFile(AtomicFile&&) noexcept = default;
    AtomicFile& operator=(AtomicFile&&) = delete;
    ~AtomicFile();  ///< removes what was not committed

    std::optional<diag::Failure> write(std::string_view bytes);
    /// Waits until the disk has what was written.
    std::optional<diag::Failure> sync();
    /// Calls commit_all() for this file alone.
    std::optional<diag::Failure> commit(const StillRight& is_right = nullptr);

private:
    friend std::optional<Uncommitted> commit_all(const std::vector<AtomicFile*>& files,
                                                 const StillRight& is_right);

    AtomicFile(std::string name, Descriptor folder, Descriptor file, diag::Code code);

    std::optional<diag::Failure> failed(int error) const;
    bool open_temporary(mode_t mode);
    void copy_permissions(const struct stat& of);
    /// Returns the errors that a file system reports only on close, such as a full disk.
    std::optional<diag::Failure> finish();
    template <class Create>
    bool take_temporary_name(const Create& create);
    /// Gives a nameless file its temporary name.
    std::optional<diag::Failure> name();
    /// Replaces the old file.
    std::optional<diag::Failure> place();
    bool is_direct() const { return name_.empty(); }

    std::string name_;       ///< name in its folder; empty: written in place
    std::string temporary_;  ///< empty: the file is nameless, or has its name
    Descriptor folder_;
    Descriptor file_;
    diag::Code code_;
};

/// Gives all files their names in this order. No file is replaced before all are complete and on
/// the file system, so a full disk leaves all old files; where the system then fails to replace
/// one, those before it are new. Processes that commit to the folder of the last file, pipes and
/// devices aside, take turns, so that their files do not mix. With `is_right`, about the first
/// file, nothing is committed where another process has the folder's lock for more than a second.
std::optional<Uncommitted> commit_all(const std::vector<AtomicFile*>& files,
                                      const StillRight& is_right = nullptr);

/// Writes `bytes` as the whole content of `path`.
std::optional<diag::Failure> write_file_atomically(const std::string& path, std::string_view bytes,
                                                   diag::Code code,
                                                   const StillRight& is_right = nullptr);

/// Does so, and returns when the disk has the bytes, and the name where its file system tells.
std::optional<diag::Failure> write_file_durably(const std::string& path, std::string_view bytes,
                                                diag::Code code,
                                                const StillRight& is_right = nullptr);

}  // namespace etlc::data
