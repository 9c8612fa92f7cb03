#include "driver/fleet/options.hpp"

#include <charconv>

#include "driver/output_file.hpp"
#include "episodes/shared/part.hpp"

namespace etlc::driver {

namespace {

/// "3/64"; of a rank of an MPI job "-/64".
bool read_shard(std::string_view text, ShardRequest& request) {
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

void add_shard_option(CLI::App& app, ShardRequest& request, const std::string& description) {
    app.add_option_function<std::string>(
           "--shard",
           [&request](const std::string& text) {
               if (!read_shard(text, request))
                   throw CLI::ValidationError(
                       "--shard",
                       "'" + text + "' is no shard; expected I/N with I from 1 to N: 3/64");
           },
           description)
        ->type_name("I/N");
}

void add_shard_options(CLI::App& app, ShardRequest& request) {
    add_shard_option(app, request,
                     "read only this shard of the episodes, and write a part of the result; etlc "
                     "merge makes the result of all parts");
    app.add_option("--part", request.part, "with --shard: the part to write")->type_name("FILE");
}

std::string mistake_in_shard_call(const ShardRequest& request) {
    if (request.part == kStandardOutput) return "--part names a file, not standard output";
    if ((request.shards == 0) == request.part.empty()) return "";
    return request.part.empty() ? "--shard needs --part, the file to write"
                                : "--part goes with --shard";
}

}  // namespace etlc::driver
