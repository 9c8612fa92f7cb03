#include "recordings/episodes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>
#include <system_error>

#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/hdf5/hdf5.hpp"
#include "recordings/open.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

namespace fs = std::filesystem;
using diag::Code;

constexpr std::string_view kPatternCharacters = "*?[";

std::string expected() {
    return "expected files that end in " + trace_endings();
}

bool is_directory(const std::string& path) {
    std::error_code error;
    return fs::is_directory(path, error);
}

bool is_labels_file(const std::string& path) {
    return fs::path(path).filename() == kLabelsFile;
}

/// Lists the traces in a folder, without its subfolders.
diag::Result<std::vector<std::string>> in_folder(const std::string& folder) {
    std::vector<std::string> files;
    bool has_folders = false;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        const std::string path = it->path().string();
        has_folders |= is_directory(path);
        if (is_trace(path) && !is_directory(path) && !is_labels_file(path)) files.push_back(path);
    }
    if (error)
        return diag::Failure{Code::unreadable_trace,
                             fmt::format("cannot be read: {}", error.message())};
    if (files.empty())
        return diag::Failure{
            Code::unreadable_trace,
            with_dataset_meant(
                fmt::format("holds no episodes, {}{}", expected(),
                            has_folders ? fmt::format("; name its folders, such as '{}'",
                                                      (fs::path(folder) / "*").string())
                                        : ""),
                folder)};
    return files;
}

/// Lists the paths that match; folders stand for the traces in them.
diag::Result<std::vector<std::string>> matching(const std::string& pattern, diag::Sink& sink) {
    const auto paths = paths_matching(pattern);
    if (!paths)
        return diag::Failure{Code::unreadable_trace, "a folder of this pattern cannot be read"};
    if (paths->empty())
        return diag::Failure{Code::unreadable_trace, "no file matches this pattern"};
    std::vector<std::string> files;
    for (const std::string& path : *paths) {
        const auto inside = is_dataset(path)     ? find_dataset_episodes({path}, sink)
                            : is_directory(path) ? in_folder(path)
                                                 : std::vector<std::string>{path};
        if (!inside && is_dataset(path)) return inside;
        if (inside) files.insert(files.end(), inside->begin(), inside->end());
    }
    if (files.empty())
        return diag::Failure{Code::unreadable_trace,
                             fmt::format("only folders match, without episodes, {}", expected())};
    return files;
}

/// A path that exists is taken literally, whatever characters it has.
diag::Result<std::vector<std::string>> expand(const std::string& argument, diag::Sink& sink) {
    if (const auto set = dataset_path(argument)) return find_dataset_episodes(*set, sink);
    if (is_directory(argument)) return in_folder(argument);
    const auto why = why_unreadable(argument);
    if (!why) return std::vector<std::string>{argument};
    if (argument.find_first_of(kPatternCharacters) != std::string::npos)
        return matching(argument, sink);
    return diag::Failure{Code::unreadable_trace, with_dataset_meant(*why, argument)};
}

/// Returns the CRC-32 of an episode's file; of its number or group where the file has several.
std::uint32_t sum_of(const std::string& episode) {
    std::string piece;
    uLong sum = crc32(0, nullptr, 0);
    const auto add = [&] {
        sum = crc32(sum, reinterpret_cast<const Bytef*>(piece.data()),
                    static_cast<uInt>(piece.size()));
    };
    if (trace_file(episode) != episode) {
        piece = episode.substr(episode.rfind(':') + 1);
        add();
        return static_cast<std::uint32_t>(sum);
    }
    std::ifstream file(episode, std::ios::binary);
    while (file) {
        piece.resize(1U << 16U);
        file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        piece.resize(static_cast<std::size_t>(file.gcount()));
        add();
    }
    return static_cast<std::uint32_t>(sum);
}

/// Keeps the episodes of a part, in their order.
void keep(const Part& part, std::vector<std::string>& episodes, diag::Sink& sink) {
    if (part.from == 0 && part.to == 1) return;
    std::vector<std::size_t> order(episodes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!part.in_order) {
        std::vector<std::uint32_t> sums;
        for (const std::string& episode : episodes) sums.push_back(sum_of(episode));
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return sums[a] < sums[b]; });
    }
    const auto place = [&](double share) {
        return order.begin() + static_cast<std::ptrdiff_t>(
                                   std::nearbyint(share * static_cast<double>(order.size())));
    };
    std::vector<std::size_t> kept(place(part.from), place(part.to));
    std::sort(kept.begin(), kept.end());
    std::vector<std::string> result;
    for (const std::size_t k : kept) result.push_back(std::move(episodes[k]));
    if (result.empty() && !episodes.empty())
        sink.report(in_file(
            {Code::unreadable_trace, fmt::format("no episode is in this part of {}", order.size())},
            fmt::format("--split {}:{}", part.from, part.to)));
    episodes = std::move(result);
}

}  // namespace

std::vector<std::string> find_episodes(const std::vector<std::string>& arguments,
                                       const Chosen& chosen, diag::Sink& sink) {
    const std::string& groups = chosen.groups;
    std::vector<std::string> episodes;
    std::set<std::string> seen;
    std::string table;  // a pattern of the shell may match it too
    for (const std::string& argument : arguments) {
        auto files = expand(argument, sink);
        if (!files) {
            sink.report(in_file(files.failure(), argument));
            continue;
        }
        std::sort(files->begin(), files->end());
        for (const std::string& file : *files) {
            if (is_labels_file(file)) {
                table = file;
                continue;
            }
            if (!seen.insert(fs::path(file).lexically_normal().string()).second) continue;
            const std::string place = trace_file(file);
            const auto why = is_directory(place) ? std::nullopt : why_unreadable(place);
            if (why) {
                sink.report(in_file({Code::unreadable_trace, *why}, file));
                continue;
            }
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
    if (episodes.empty() && !table.empty() && !sink.has_errors())
        sink.report(
            in_file({Code::unreadable_trace, "is a table of labels, and no episode"}, table));
    if (!sink.has_errors()) keep(chosen.part, episodes, sink);
    return episodes;
}

namespace {

/// Returns the bits in the byte order of files.
std::uint32_t bits_of(float number) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    return std::endian::native == std::endian::big ? __builtin_bswap32(bits) : bits;
}

void append_bits(const std::vector<float>& numbers, std::vector<std::uint32_t>& bits) {
    const std::size_t begin = bits.size();
    bits.resize(begin + numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) bits[begin + i] = bits_of(numbers[i]);
}

}  // namespace

EpisodeHash::EpisodeHash(std::vector<HashedInput> inputs) : inputs_(std::move(inputs)) {
    for (const HashedInput& input : inputs_) readers_.emplace_back(input.tells_alone);
}

void EpisodeHash::add(const std::vector<std::vector<float>>& samples) {
    constexpr float kMissing = std::bit_cast<float>(std::uint32_t{0x7fc00000});  // NaN
    bits_.clear();
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const std::size_t begin = bits_.size();
        const bool present = !samples[i].empty();
        if (present)
            append_bits(samples[i], bits_);
        else
            bits_.resize(begin + inputs_[i].dimension, bits_of(kMissing));
        readers_[i].add(bits_.data() + begin, bits_.size() - begin, present);
    }
    hash_ = xxh64({reinterpret_cast<const char*>(bits_.data()), 4 * bits_.size()}, hash_);
    ++steps_;
}

std::string EpisodeHash::text() const {
    return hash_text(xxh64(fmt::format("{} steps", steps_), hash_));
}

EpisodeContent EpisodeHash::content() const {
    EpisodeContent result;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
        result[inputs_[i].name] = readers_[i].content();
    return result;
}

}  // namespace etlc::recordings
