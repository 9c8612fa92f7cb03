#include "data/traces/trace.hpp"

#include <filesystem>
#include <system_error>

#include "data/files/file.hpp"
#include "data/traces/hdf5.hpp"
#include "data/traces/trace_formats.hpp"

namespace etlc::data {
namespace {

/// Where in "runs.h5:data/demo_0" the colon stands, unless that is the name of a file.
std::size_t group_mark(const std::string& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error)) return std::string::npos;
    for (std::size_t at = path.find(':'); at != std::string::npos; at = path.find(':', at + 1))
        if (is_hdf5(path.substr(0, at))) return at;
    return std::string::npos;
}

}  // namespace

std::vector<Channel> renamed(std::vector<Channel> channels, const NamesInFile& names) {
    for (Channel& channel : channels)
        if (const auto found = names.find(channel.name); found != names.end())
            channel.name = found->second;
    return channels;
}

bool is_trace(const std::string& path) {
    return path.ends_with(".npz") || path.ends_with(".csv") || is_hdf5(path);
}

std::string trace_file(const std::string& path) {
    return path.substr(0, group_mark(path));
}

diag::Failure no_steps() {
    return {diag::Code::empty_trace, "holds no step, expected at least one"};
}

diag::Diagnostic in_trace(const diag::Failure& failure, const std::string& path) {
    diag::Diagnostic result = in_file(failure, path);
    if (failure.code == diag::Code::no_such_channel)
        result.note("--map NAME=NAME_IN_FILE says what an input is called in the file");
    if (failure.code == diag::Code::no_label)
        result.note(
            "--map truth.NAME=NAME_IN_FILE says what the labels are called in the file; a 'truth' "
            "in the spec makes them of other inputs");
    return result;
}

diag::Result<std::unique_ptr<Trace>> open_trace(const std::string& path,
                                                const std::vector<Channel>& channels) {
    if (path.ends_with(".npz")) return open_npz_trace({path, {}, false}, channels);
    const std::size_t mark = group_mark(path);
    if (mark != std::string::npos)
        return open_hdf5_trace(path.substr(0, mark), path.substr(mark + 1), channels);
    if (is_hdf5(path)) return open_hdf5_trace(path, "", channels);
    if (!path.ends_with(".csv"))
        return diag::Failure{diag::Code::unknown_trace_format,
                             "unknown kind of trace, expected .csv, .npz or .h5"};
    auto source = open_file(path);
    if (!source) return of_trace(source.failure());
    return open_csv_trace(std::move(*source), channels);
}

}  // namespace etlc::data
