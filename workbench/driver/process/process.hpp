// The process of etlc: standard streams, signals, exit statuses and progress.
// Keeps true: nothing here throws; no input, output or lack of resources ends the process by a
// signal, except SIGPIPE, which ends it quietly when nobody reads its output any more. Progress is
// shown on terminals only, and erased at the end.
#pragma once

#include <unistd.h>

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/atomic_file.hpp"
#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::driver {

// The exit statuses of etlc.
inline constexpr int kDone = 0;
inline constexpr int kFailed =
    1;  ///< a diagnostic explains it: a wrong spec, wrong data, or a lack of resources
inline constexpr int kWrongCall = 2;
inline constexpr int kOwnFault = 3;  ///< an internal error

/// Prepares the process; call it before a file is opened. Opens closed standard descriptors, so
/// that no file gets their numbers: standard output then cannot be written, and standard error goes
/// nowhere. Makes a file that grows beyond its limit an error in place of a signal.
void prepare_process();

/// Prints what the current exception means, without allocating memory, and returns the exit status.
/// prepare_process() also makes std::terminate call it.
int say_what_failed() noexcept;

/// Writes to standard error; false where that fails.
bool print_error(std::string_view text);

/// Prints the findings as "text" or "json" and returns the exit status.
int conclude(const std::string& form, const source::File& file, const diag::Sink& sink);

constexpr char kEraseProgress[] = "\r                                        \r";

inline bool progress_is_seen() {
    return isatty(STDERR_FILENO) != 0;
}

/// Returns a function that shows how many episodes are done; empty where nobody would see it.
inline std::function<void(std::size_t done, std::size_t total)> episodes_progress() {
    if (!progress_is_seen()) return {};
    return [](std::size_t done, std::size_t total) {
        print_error(fmt::format("\r{} of {} episodes", done, total));
        if (done == total) print_error(kEraseProgress);
    };
}

// The output files of a call, and its standard output.
// Keeps true: a file appears whole, and only when all files of the call are complete; write errors
// are reported; no output is a file that the call reads, and no two outputs are the same file.

/// The path that stands for standard output.
inline constexpr std::string_view kStandardOutput = "-";

/// Reports outputs that are the same file as an input or as each other; false where it did. Empty
/// paths are skipped; terminals, pipes and devices may be given twice.
bool check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   diag::Sink& sink);

/// Makes a folder and those above it; reports an error and returns false where that fails.
bool make_folder(const std::string& folder, diag::Sink& sink);

class OutputFiles {
public:
    explicit OutputFiles(diag::Sink& sink) : sink_(sink) {}

    /// Begins the next file, which `write` then writes to. Output to `-`, standard output, is
    /// visible at once. All functions return false after they have reported an error.
    bool begin(const std::string& path);
    bool write(std::string_view bytes);
    bool add(const std::string& path, std::string_view bytes) {
        return begin(path) && write(bytes);
    }
    /// Gives all files their names, in the order in which they were begun; see data::commit_all.
    bool commit(const data::StillRight& is_right = nullptr);

private:
    bool report(const diag::Failure& failure, const std::string& path);

    struct File {
        std::string path;
        data::AtomicFile file;
    };
    diag::Sink& sink_;
    std::vector<File> files_;
};

/// Writes to standard output at once; reports an error and returns false where that fails.
bool print(std::string_view text, diag::Sink& sink);
/// Writes a text that is all that a call asks for, such as --help, and returns the exit status.
int print_text(std::string_view text);

}  // namespace etlc::driver
