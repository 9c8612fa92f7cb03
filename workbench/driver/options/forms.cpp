#include "driver/options/forms.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <utility>

#include "driver/compile/names.hpp"
#include "episodes/shared/part.hpp"
#include "library/recorder.hpp"
#include "library/settings.hpp"

namespace etlc::driver {

std::string read_settings(Call& call, const std::vector<std::string>& words) {
    std::string mistake;
    if (auto parsed = library::parse_settings(words, mistake)) call.settings() = std::move(*parsed);
    return mistake;
}

std::string read_names(Call& call, const std::vector<std::string>& words) {
    std::string mistake;
    if (auto parsed = parse_names(words, mistake)) call.names() = std::move(*parsed);
    return mistake;
}

std::string read_cameras(Call& call, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        const std::size_t sign = word.find('=');
        const std::string input = sign == std::string::npos ? "" : word.substr(0, sign);
        const std::string camera = sign == std::string::npos ? word : word.substr(sign + 1);
        if (camera.empty() || sign == 0)
            return fmt::format("--camera takes NAME or INPUT=NAME, not '{}'", word);
        if (!call.embed.cameras.emplace(input, camera).second)
            return input.empty() ? "--camera names two cameras"
                                 : fmt::format("--camera names '{}' twice", input);
    }
    return "";
}

namespace {

bool parse_shard(std::string_view text, ShardRequest& request) {
    const char* const end = text.data() + text.size();
    if (text.starts_with("-/")) {
        request.from_input = true;
        const auto [rest, error] = std::from_chars(text.data() + 2, end, request.shards);
        return error == std::errc() && rest == end && request.shards >= 1 &&
               request.shards <= episodes::kMostShards;
    }
    const auto [slash, error] = std::from_chars(text.data(), end, request.shard);
    if (error != std::errc() || slash == end || *slash != '/') return false;
    const auto [rest, wrong] = std::from_chars(slash + 1, end, request.shards);
    return wrong == std::errc() && rest == end && request.shard >= 1 &&
           request.shard <= request.shards && request.shards <= episodes::kMostShards;
}

}  // namespace

std::string read_shard(Call& call, const std::vector<std::string>& words) {
    if (parse_shard(words.front(), call.shard())) return "";
    return fmt::format("--shard: '{}' is no shard; expected I/N with I from 1 to N: 3/64",
                       words.front());
}

std::string read_recorder(Call& call, const std::vector<std::string>& words) {
    std::string unused;
    call.request.recorder = library::parse_recorder(words.front(), unused);
    return "";
}

std::string read_seconds(Call& call, const std::vector<std::string>& words) {
    double seconds = 0;
    std::from_chars(words.front().data(), words.front().data() + words.front().size(), seconds);
    call.explain.at = seconds;
    return "";
}

std::string read_suggest(Call& call, const std::vector<std::string>& words) {
    call.fit.suggest = true;
    for (const std::string& word : words)
        if (!word.empty()) call.fit.predicates.push_back(word);  // "" is what CLI11 makes of none
    return "";
}

}  // namespace etlc::driver
