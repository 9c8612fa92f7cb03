#include "data/traces/trace.hpp"

#include <filesystem>
#include <string_view>
#include <system_error>

#include "data/text/number.hpp"

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

}  // namespace

bool is_hdf5(const std::string& path) {
    return path.ends_with(".h5") || path.ends_with(".hdf5");
}

bool is_dataset(const std::string& folder) {
    std::error_code error;
    return std::filesystem::exists(folder + "/meta/info.json", error);
}

std::optional<DatasetPath> dataset_path(const std::string& path) {
    std::error_code error;
    if (is_dataset(path)) {
        const std::size_t end = path.find_last_not_of('/');
        return DatasetPath{end == std::string::npos ? path : path.substr(0, end + 1)};
    }
    if (std::filesystem::exists(path, error)) return std::nullopt;
    std::vector<std::uint64_t> numbers;
    std::string folder = path;
    while (numbers.size() < 2 && !is_dataset(folder)) {
        const std::size_t colon = folder.rfind(':');
        if (colon == std::string::npos) return std::nullopt;
        const auto number = parse_whole<std::uint64_t>(std::string_view(folder).substr(colon + 1));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        folder.resize(colon);
    }
    if (!is_dataset(folder)) return std::nullopt;
    if (numbers.size() == 1) return DatasetPath{folder, numbers[0], numbers[0] + 1};
    return DatasetPath{folder, numbers[1], numbers[0]};
}

std::string trace_file(const std::string& path) {
    if (const auto set = dataset_path(path)) return set->folder;
    return path.substr(0, group_mark(path));
}

}  // namespace etlc::data
