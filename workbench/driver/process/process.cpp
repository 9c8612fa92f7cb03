#include "driver/process/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <new>
#include <system_error>
#include <utility>

#include "data/files/file.hpp"
#include "data/spill/spill.hpp"
#include "diag/diag.hpp"
#include "recordings/open.hpp"

namespace etlc::driver {

namespace {

constexpr std::string_view kNoMemory = "etlc: there is not enough memory\n";

}  // namespace

int say_what_failed() noexcept {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        print_error(kNoMemory);
        return kFailed;
    } catch (const data::SpillError& error) {
        for (const std::string_view part : {"etlc: ", error.what(), "\n"}) print_error(part);
        return kFailed;
    } catch (const std::exception& error) {
        for (const std::string_view part : {"etlc: internal error: ", error.what(), "\n"})
            print_error(part);
    } catch (...) {
        print_error("etlc: internal error\n");
    }
    return kOwnFault;
}

namespace {

/// Ends the process in std::terminate. Some noexcept functions of libraries allocate memory:
/// destructors of nlohmann::json, iterators of std::filesystem. An exception that leaves one is not
/// the current exception, and can only be std::bad_alloc.
[[noreturn]] void end() noexcept {
    if (std::current_exception()) ::_exit(say_what_failed());
    if (std::uncaught_exceptions() == 0) ::abort();
    print_error(kNoMemory);
    ::_exit(kFailed);
}

}  // namespace

void prepare_process() {
    std::set_terminate(end);
    ::signal(SIGXFSZ, SIG_IGN);
    // open() returns the lowest free descriptor.
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(standard, F_GETFD) < 0)
            static_cast<void>(::open("/dev/null", standard == STDERR_FILENO ? O_WRONLY : O_RDONLY));
}

bool print_error(std::string_view text) {
    return data::write_all(STDERR_FILENO, text);
}

int conclude(const std::string& form, const source::File& file, const diag::Sink& sink) {
    const auto colour = isatty(STDERR_FILENO) != 0 ? diag::Colour::ansi : diag::Colour::none;
    const bool printed = print_error(form == "json" ? diag::render_json(file, sink)
                                                    : diag::render_text(file, sink, colour));
    return sink.refused() || !printed ? kFailed : kDone;
}

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

bool make_folder(const std::string& folder, diag::Sink& sink) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error) return true;
    sink.report(data::in_file(
        {Code::unwritable_output, fmt::format("cannot be made: {}", error.message())}, folder));
    return false;
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
    return report(uncommitted->failure, files_[uncommitted->file].path);
}

bool print(std::string_view text, diag::Sink& sink) {
    OutputFiles files(sink);
    return files.add(std::string(kStandardOutput), text) && files.commit();
}

int print_text(std::string_view text) {
    diag::Sink sink;
    print(text, sink);
    return conclude("text", source::File(), sink);
}

}  // namespace etlc::driver
