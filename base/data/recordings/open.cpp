#include "data/recordings/open.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "data/datasets/trace.hpp"
#include "data/files/file.hpp"
#include "data/hdf5/hdf5.hpp"
#include "data/text/quote.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {

namespace {

/// Finds the colon of "runs.h5:data/demo_0", unless that is the name of a file.
std::size_t group_mark(const std::string& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error)) return std::string::npos;
    for (std::size_t at = path.find(':'); at != std::string::npos; at = path.find(':', at + 1))
        if (is_hdf5(path.substr(0, at))) return at;
    return std::string::npos;
}

/// Returns "; did you mean 'run_01.csv'?" where there is no such file, but one of a near name.
std::string file_meant(const std::string& file) {
    constexpr std::size_t kMost = 1000;  // an edit distance is computed to each
    std::vector<std::string> names;
    std::error_code error;
    if (std::filesystem::exists(file, error)) return "";
    const std::filesystem::path path(file);
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    for (std::filesystem::directory_iterator it(folder, error), end;
         !error && it != end && names.size() < kMost; it.increment(error))
        if (is_trace(it->path().string())) names.push_back(it->path().filename().string());
    std::sort(names.begin(), names.end());
    return suggestion(path.filename().string(), names);
}

using Opened = diag::Result<std::unique_ptr<Trace>>;

Opened open_csv(const std::string& path, const std::vector<Channel>& channels) {
    auto source = open_file(path, Streams::taken);
    if (!source) return of_trace(source.failure());
    return open_csv_trace(std::move(*source), channels);
}

Opened open_npz(const std::string& path, const std::vector<Channel>& channels) {
    return open_npz_trace({path, {}, false}, channels);
}

Opened open_hdf5(const std::string& path, const std::vector<Channel>& channels) {
    const std::size_t mark = group_mark(path);
    const std::string group = mark == std::string::npos ? "" : path.substr(mark + 1);
    return open_hdf5_trace(path.substr(0, mark), group, channels);
}

/// A format and the ending of its files.
struct Format {
    const char* ending;
    Opened (*open)(const std::string& path, const std::vector<Channel>& channels);
};

constexpr Format kFormats[] = {
    {".csv", open_csv}, {".npz", open_npz}, {".h5", open_hdf5}, {".hdf5", open_hdf5}};

/// Finds the format of a file; null for other endings.
const Format* format_of(const std::string& file) {
    for (const Format& format : kFormats)
        if (file.ends_with(format.ending)) return &format;
    return nullptr;
}

}  // namespace

bool is_trace(const std::string& path) {
    return format_of(path) != nullptr;
}

std::string trace_endings() {
    std::vector<std::string> endings;
    for (const Format& format : kFormats) endings.emplace_back(format.ending);
    return diag::alternatives(endings);
}

std::string trace_file(const std::string& path) {
    if (const auto set = dataset_path(path)) return set->folder;
    return path.substr(0, group_mark(path));
}

diag::Failure no_steps() {
    return {diag::Code::empty_trace, "holds no step, expected at least one"};
}

diag::Diagnostic in_trace(const diag::Failure& failure, const std::string& path) {
    diag::Diagnostic result = in_file(failure, path == kStandardInput ? "standard input" : path);
    if (failure.code == diag::Code::no_such_channel)
        result.note("--map NAME=NAME_IN_FILE says what an input is called in the file");
    if (failure.code == diag::Code::no_label)
        result.note(
            "--map truth.NAME=NAME_IN_FILE says what the labels are called in the file; a 'truth' "
            "in the spec makes them of other inputs; a table labels.csv beside the files has them "
            "in rows, where !NAME says that NAME never holds");
    if (failure.code == diag::Code::video_out_of_step)
        result.note(
            "every step has a row: fill a gap with rows whose samples are missing (empty cells of "
            "a .csv file, NaN in arrays), or cut the recording there; a 'time' that is not that of "
            "the steps needs another name");
    return result;
}

diag::Result<std::unique_ptr<Trace>> open_trace(const std::string& path,
                                                const std::vector<Channel>& channels) {
    if (path == kStandardInput) return open_csv_trace(standard_input(), channels);
    if (dataset_path(path)) return open_dataset_trace(path, channels);
    if (const Format* format = format_of(trace_file(path))) {
        auto opened = format->open(path, channels);
        if (opened) return opened;
        diag::Failure failure = opened.failure();
        failure.message += file_meant(trace_file(path));
        return failure;
    }
    return diag::Failure{
        diag::Code::unknown_trace_format,
        with_dataset_meant("unknown kind of trace, expected " + trace_endings(), path)};
}

std::vector<Channel> renamed(std::vector<Channel> channels, const NamesInFile& names) {
    for (Channel& channel : channels) channel.name = name_in_file(channel.name, names);
    return channels;
}

const std::string& name_in_file(const std::string& name, const NamesInFile& names) {
    const auto found = names.find(name);
    return found == names.end() ? name : found->second;
}

}  // namespace etlc::data
