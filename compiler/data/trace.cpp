#include "data/trace.hpp"

#include "data/trace_formats.hpp"

namespace etlc::data {

bool is_trace(const std::string& path) {
    return path.ends_with(".npz") || path.ends_with(".csv");
}

diag::Result<std::unique_ptr<Trace>> open_trace(const std::string& path, const std::vector<Channel>& channels) {
    if (path.ends_with(".npz")) return open_npz_trace({path, {}, false}, channels);
    if (!path.ends_with(".csv"))
        return diag::Failure{diag::Code::unknown_trace_format, "unknown kind of trace, expected .csv or .npz"};
    auto source = open_file(path);
    if (!source) return of_trace(source.failure());
    return open_csv_trace(std::move(*source), channels);
}

}  // namespace etlc::data
