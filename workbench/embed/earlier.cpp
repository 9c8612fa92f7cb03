#include "embed/earlier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "artifacts/embedded.hpp"
#include "data/arrays/array.hpp"
#include "data/files/hash.hpp"

namespace etlc::embed {

namespace {

std::string hash_of(const std::string& path) {
    const auto hash = data::hash_of_file(path, diag::Code::unreadable_data_file);
    return hash ? *hash : "";
}

/// Returns whether a video is a text, which may be a playlist: its frames are in other files.
bool may_name_others(const std::string& video) {
    return data::ends_of_file(video).find('\0') == std::string::npos;
}

/// Hashes the files that a command names: the program, its script, its weights.
std::string hashes_of_words(const std::string& command) {
    constexpr std::string_view kBetweenWords = " \t\n\"'`;&|<>()=";
    std::string hashes;
    for (std::size_t begin = 0; begin < command.size();) {
        const std::size_t end =
            std::min(command.find_first_of(kBetweenWords, begin), command.size());
        if (end > begin) hashes += hash_of(command.substr(begin, end - begin)) + "\n";
        begin = end + 1;
    }
    return hashes;
}

}  // namespace

Earlier::Earlier(const Running& running, const std::string& version)
    : made_by_(version + "\n" + running.command + "\n" +
               (running.command.empty() ? hash_of(running.onnxruntime)
                                        : hashes_of_words(running.command)) +
               "\n") {}

std::string Earlier::hash(const std::string& path, bool is_shared) {
    if (!is_shared) return hash_of(path);
    std::string& known = shared_[path];
    if (known.empty()) known = hash_of(path);
    return known;
}

std::string Earlier::origin(const Recording& recording, const std::string& input,
                            const std::string& encoder) {
    const Origin from = recording.origin(input);
    if (!from.video.empty() && may_name_others(from.video)) return {};
    std::string text = made_by_ + encoder + "\n" + from.choice + "\n";
    const auto add = [&](const std::string& path) {
        const std::string found = hash(path, recording.files.empty());
        text += found + "\n";
        return !found.empty();
    };
    if (!from.video.empty() && !add(from.video)) return {};
    for (const std::string& path : from.files)
        if (!add(path)) return {};
    return text;
}

std::string bound(const std::string& origin, std::uint32_t dimension,
                  const std::vector<float>& rows) {
    const std::string content = data::content_hash({rows.size() / dimension, dimension}, rows);
    return data::hash_text(data::xxh64(origin + content));
}

std::optional<std::vector<float>> embeddings_in(const std::string& episode,
                                                const std::string& input, std::uint32_t dimension,
                                                const std::string& origin) {
    if (origin.empty()) return std::nullopt;
    const embedded::Origins origins = embedded::read_origins(episode);
    const auto known = origins.find(input);
    if (known == origins.end()) return std::nullopt;
    const auto array = data::read_npz(episode, input);
    if (!array || array->element != data::Element::f32 || array->shape.size() != 2 ||
        array->shape[1] != dimension)
        return std::nullopt;
    std::vector<float> rows(array->values.begin(), array->values.end());
    if (bound(origin, dimension, rows) != known->second) return std::nullopt;
    return rows;
}

}  // namespace etlc::embed
