// The output files of a call, and its standard output.
// Keeps true: all files of a call appear or none, each whole; write errors are reported; no output
// is a file that the call reads, and no two outputs are the same file.
#pragma once

#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/atomic_file.hpp"
#include "diag/diag.hpp"

namespace etlc::driver {

/// The path that stands for standard output.
inline constexpr std::string_view kStandardOutput = "-";

/// Reports outputs that are the same file as an input or as each other; false where it did. Empty
/// paths are skipped; terminals, pipes and devices may be given twice.
bool check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   diag::Sink& sink);

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
    /// Gives all files their names, in the order in which they were begun, or none. `is_right`: as
    /// for data::commit_all.
    bool commit(const data::StillRight& is_right = nullptr);

private:
    bool report(const diag::Failure& failure, const std::string& path);

    struct File {
        std::string path;
        data::AtomicFile file;
    };
    diag::Sink& sink_;
    std::list<File> files_;
};

/// Writes to standard output at once; reports an error and returns false where that fails.
bool print(std::string_view text, diag::Sink& sink);

}  // namespace etlc::driver
