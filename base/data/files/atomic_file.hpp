// Files that appear whole or not at all.
// Takes: a path and bytes. Gives: a file of that name with these bytes, or a Failure that carries
// the code which the caller names; its message does not repeat the path: `in_file`
// (data/files/file.hpp) puts both together. Keeps true: a failed write leaves what stood there
// before, and no other file. A process that is killed leaves none either: until it is complete a
// file has no name, where the file system knows such files. There is a window of a few system calls
// while names change hands, and there are file systems without nameless files: a kill then leaves
// `.etlc-PROCESS-NUMBER.part`, until the next call that writes into that folder. A file that is
// replaced keeps its permissions, and its owner and group where the system lets them be kept.
// Nothing waits for the disk: a machine that loses its power loses what it had not yet stored.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/descriptor.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

/// Which file could not take its name, and why.
struct Uncommitted {
    std::size_t file;
    diag::Failure failure;
};

/// A file that takes its own name only when it is complete.
/// A path that is a device, a pipe, /dev/stdout or /dev/stderr is written to directly; of a
/// symbolic link, the file it points to is made or replaced.
class AtomicFile {
public:
    static diag::Result<AtomicFile> create(const std::string& path, diag::Code code);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    ~AtomicFile();  ///< takes back what was not kept

    std::optional<diag::Failure> write(std::string_view bytes);
    /// commit_all() of this file alone.
    std::optional<diag::Failure> commit();

private:
    friend std::optional<Uncommitted> commit_all(const std::vector<AtomicFile*>& files);

    AtomicFile(std::string name, Descriptor folder, Descriptor file, diag::Code code);

    std::optional<diag::Failure> failed(int error) const;
    bool open_temporary(mode_t mode);
    void copy_permissions(const struct stat& of);
    /// What the file system says only when a file is closed: of a full disk, for example.
    std::optional<diag::Failure> finish();
    /// Puts the file under its name; what was there before is kept until keep().
    std::optional<diag::Failure> place();
    bool link_as(const char* name);
    bool name_temporarily();
    void keep();
    void take_back();

    enum class State : std::uint8_t {
        direct,     ///< no file of ours
        nameless,   ///< nor will it be seen
        temporary,  ///< under its temporary name
        made,       ///< under its name, where nothing was before
        exchanged,  ///< under its name; what was there before has the temporary one
        kept
    };
    State state_ = State::direct;
    std::string name_;  ///< in its folder
    std::string temporary_;
    Descriptor folder_;
    Descriptor file_;
    diag::Code code_;
};

/// The files take their names in this order, or none of them does: one that cannot makes those
/// before it take back theirs. Processes that commit to the folder of the last file take turns, so
/// that what they write does not mix.
std::optional<Uncommitted> commit_all(const std::vector<AtomicFile*>& files);

/// The whole of `bytes` as the content of `path`.
std::optional<diag::Failure> write_file_atomically(const std::string& path, std::string_view bytes,
                                                   diag::Code code);

}  // namespace etlc::data
