#include "data/episodes.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <set>
#include <system_error>

#include "data/file.hpp"
#include "data/hash.hpp"
#include "data/hdf5.hpp"

namespace etlc::data {
namespace {

namespace fs = std::filesystem;
using diag::Code;

constexpr std::string_view kPatternCharacters = "*?[";
constexpr std::string_view kExpected = "expected files that end in .npz, .csv or .h5";

bool is_directory(const std::string& path) {
    std::error_code error;
    return fs::is_directory(path, error);
}

/// The traces in a folder, not in those below it.
diag::Result<std::vector<std::string>> in_folder(const std::string& folder) {
    std::vector<std::string> files;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        const std::string path = it->path().string();
        if (is_trace(path) && !is_directory(path)) files.push_back(path);
    }
    if (error)
        return diag::Failure{Code::unreadable_trace,
                             fmt::format("cannot be read: {}", error.message())};
    if (files.empty())
        return diag::Failure{Code::unreadable_trace,
                             fmt::format("holds no episodes, {}", kExpected)};
    return files;
}

/// What matches; folders among it stand for the traces in them.
diag::Result<std::vector<std::string>> matching(const std::string& pattern) {
    glob_t found{};
    const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
    std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    ::globfree(&found);
    if (status == GLOB_NOMATCH)
        return diag::Failure{Code::unreadable_trace, "no file matches this pattern"};
    if (status != 0)
        return diag::Failure{Code::unreadable_trace, "a folder of this pattern cannot be read"};
    std::vector<std::string> files;
    for (const std::string& path : paths) {
        if (!is_directory(path)) {
            files.push_back(path);
            continue;
        }
        const auto inside = in_folder(path);
        if (inside) files.insert(files.end(), inside->begin(), inside->end());
    }
    if (files.empty())
        return diag::Failure{Code::unreadable_trace,
                             fmt::format("only folders match, without episodes, {}", kExpected)};
    return files;
}

/// A path that exists is what it says, whatever characters are in it.
diag::Result<std::vector<std::string>> expand(const std::string& argument) {
    if (is_directory(argument)) return in_folder(argument);
    const auto why = why_unreadable(argument);
    if (!why) return std::vector<std::string>{argument};
    if (argument.find_first_of(kPatternCharacters) != std::string::npos) return matching(argument);
    return diag::Failure{Code::unreadable_trace, *why};
}

}  // namespace

std::vector<std::string> find_episodes(const std::vector<std::string>& arguments,
                                       const std::string& groups, diag::Sink& sink) {
    std::vector<std::string> episodes;
    std::set<std::string> seen;
    for (const std::string& argument : arguments) {
        auto files = expand(argument);
        if (!files) {
            sink.report(in_file(files.failure(), argument));
            continue;
        }
        std::sort(files->begin(), files->end());
        for (const std::string& file : *files) {
            if (!seen.insert(fs::path(file).lexically_normal().string()).second) continue;
            if (groups.empty() || !is_hdf5(file)) {
                episodes.push_back(file);
                continue;
            }
            const auto found = list_hdf5(file, groups);
            if (!found) sink.report(in_file(found.failure(), file));
            if (found)
                for (const std::string& group : *found) episodes.push_back(file + ":" + group);
        }
    }
    return episodes;
}

void EpisodeHash::add(const Sample& sample) {
    constexpr std::uint32_t kNaN = 0x7fc00000;  // one pattern of bits for all that is missing
    std::size_t n = 0;
    for (const std::size_t c : channels_) n += sample.values[c].size();
    bits_.resize(n);
    auto to = bits_.begin();
    for (const std::size_t c : channels_) {
        const std::vector<double>& values = sample.values[c];
        const auto bits = [](double value) {
            const auto narrowed = static_cast<float>(value);
            return narrowed == narrowed ? std::bit_cast<std::uint32_t>(narrowed) : kNaN;
        };
        to = sample.present[c] ? std::transform(values.begin(), values.end(), to, bits)
                               : std::fill_n(to, values.size(), kNaN);
    }
    if constexpr (std::endian::native == std::endian::big)
        for (std::uint32_t& bits : bits_) bits = __builtin_bswap32(bits);
    const std::string_view bytes(reinterpret_cast<const char*>(bits_.data()), 4 * bits_.size());
    hash_ = xxh64(bytes, hash_);
    ++steps_;
}

std::string EpisodeHash::text() const {
    return fmt::format("{:016x}", xxh64(fmt::format("{} steps", steps_), hash_));
}

}  // namespace etlc::data
