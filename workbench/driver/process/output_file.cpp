#include "driver/process/output_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "data/files/file.hpp"
#include "recordings/open.hpp"

namespace etlc::driver {

namespace {

namespace fs = std::filesystem;
using diag::Code;

std::string words(const std::string& path, bool is_input) {
    if (is_input && path == recordings::kStandardInput) return "standard input";
    return path == kStandardOutput ? "standard output" : path;
}

/// Identifies a file by its inode, or a new file by its folder and name.
struct Identity {
    dev_t device = 0;
    ino_t inode = 0;
    std::string name;

    auto operator<=>(const Identity&) const = default;
};

/// Returns the identity of a regular or new file. `standard`: the descriptor of "-".
std::optional<Identity> identity(const std::string& path, int standard) {
    struct stat status {};
    const bool is_standard = path == kStandardOutput;
    if ((is_standard ? ::fstat(standard, &status) : ::stat(path.c_str(), &status)) == 0) {
        if (!S_ISREG(status.st_mode)) return {};
        return Identity{status.st_dev, status.st_ino, {}};
    }
    const fs::path file(path);
    if (is_standard ||
        ::stat(file.has_parent_path() ? file.parent_path().c_str() : ".", &status) != 0)
        return {};
    return Identity{status.st_dev, status.st_ino, file.filename().string()};
}

}  // namespace

bool check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   diag::Sink& sink) {
    struct Use {
        std::string path;
        bool is_input;
    };
    std::map<Identity, Use> known;
    for (const std::string& path : inputs)
        if (const auto file = identity(path, STDIN_FILENO))
            known.try_emplace(*file, Use{path, true});
    bool sound = true;
    bool prints = false;
    for (const std::string& path : outputs) {
        const auto file = path.empty() ? std::nullopt : identity(path, STDOUT_FILENO);
        std::optional<Use> other;
        if (path == kStandardOutput && std::exchange(prints, true)) other = Use{path, false};
        if (file)
            if (const auto [at, is_new] = known.try_emplace(*file, Use{path, false}); !is_new)
                other = at->second;
        if (!other) continue;
        sound = false;
        const std::string same =
            other->path == path ? "" : fmt::format(", as {}", words(other->path, other->is_input));
        sink.report(data::in_file(
            {Code::output_clash, other->is_input
                                     ? fmt::format("is read by this call{}: it would be lost", same)
                                     : fmt::format("is another output of this call{}", same)},
            words(path, false)));
    }
    return sound;
}

bool OutputFiles::report(const diag::Failure& failure, const std::string& path) {
    sink_.report(data::in_file(failure, words(path, false)));
    return false;
}

bool OutputFiles::begin(const std::string& path) {
    auto file = data::AtomicFile::create(path == kStandardOutput ? "/dev/stdout" : path,
                                         Code::unwritable_output);
    if (!file) return report(file.failure(), path);
    files_.push_back({path, std::move(*file)});
    return true;
}

bool OutputFiles::write(std::string_view bytes) {
    const auto failure = files_.back().file.write(bytes);
    return !failure || report(*failure, files_.back().path);
}

bool OutputFiles::commit(const data::StillRight& is_right) {
    std::vector<data::AtomicFile*> files;
    for (File& file : files_) files.push_back(&file.file);
    const auto uncommitted = data::commit_all(files, is_right);
    if (!uncommitted) return true;
    return report(uncommitted->failure,
                  std::next(files_.begin(), static_cast<long>(uncommitted->file))->path);
}

bool print(std::string_view text, diag::Sink& sink) {
    OutputFiles files(sink);
    return files.add(std::string(kStandardOutput), text) && files.commit();
}

}  // namespace etlc::driver
