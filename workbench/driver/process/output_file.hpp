// The files that a call writes, and what it prints.
// Takes: paths and bytes. Keeps true: all files of a call appear or none, each whole; what cannot
// be written is reported; no output is a file that the call reads, nor two outputs one file.
#pragma once

#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/atomic_file.hpp"
#include "diag/diag.hpp"

namespace etlc::driver {

/// Standard output, where a path is asked for.
inline constexpr std::string_view kStandardOutput = "-";

/// Reports outputs that are the same file as an input or as each other; empty paths are none. Only
/// what is stored counts: terminals, pipes and devices may be given twice. False where it has
/// reported something.
bool check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs,
                   diag::Sink& sink);

class OutputFiles {
public:
    explicit OutputFiles(diag::Sink& sink) : sink_(sink) {}

    /// Begins the next file; `write` goes to it. What goes to `-`, standard output, is seen at
    /// once. These return false, and have reported why, where something cannot be written.
    bool begin(const std::string& path);
    bool write(std::string_view bytes);
    bool add(const std::string& path, std::string_view bytes) {
        return begin(path) && write(bytes);
    }
    /// All files take their names, in the order of their beginnings, or none.
    bool commit();

private:
    bool report(const diag::Failure& failure, const std::string& path);

    struct File {
        std::string path;
        data::AtomicFile file;
    };
    diag::Sink& sink_;
    std::list<File> files_;
};

/// On standard output, at once. False, and reported, where not all of it can be written.
bool print(std::string_view text, diag::Sink& sink);

}  // namespace etlc::driver
