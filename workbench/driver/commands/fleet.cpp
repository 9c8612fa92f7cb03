#include "driver/commands/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "data/files/atomic_file.hpp"
#include "data/files/child.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"
#include "recordings/episodes.hpp"

namespace etlc::driver {

namespace {

using diag::Code;

/// Removes options with their values: "--jobs 4", "--jobs=4", "-j4".
std::vector<std::string> without(const std::vector<std::string>& call,
                                 const std::vector<std::string_view>& options) {
    std::vector<std::string> rest;
    for (std::size_t i = 0; i < call.size(); ++i) {
        const std::string_view word = call[i];
        const auto is_given = [&](std::string_view option) { return word == option; };
        const auto has_value = [&](std::string_view option) {
            const bool is_short = option.size() == 2;
            return word.starts_with(option) && word.size() > option.size() &&
                   (is_short || word[option.size()] == '=');
        };
        if (std::any_of(options.begin(), options.end(), is_given))
            ++i;
        else if (std::none_of(options.begin(), options.end(), has_value))
            rest.push_back(call[i]);
    }
    return rest;
}

/// Reads the next shard from standard input; nothing at its end.
std::optional<std::uint32_t> next_shard(std::uint32_t shards) {
    std::uint32_t shard = 0;
    if (!(std::cin >> shard) || shard == 0 || shard > shards) return std::nullopt;
    return shard;
}

/// Writes a part into the folder and its number to standard output.
std::optional<diag::Failure> keep_part(const std::string& folder, const episodes::Part& part) {
    const std::string path = fmt::format("{}/{}.part", folder, part.shard);
    auto failure =
        data::write_file_atomically(path, episodes::write(part), Code::unwritable_output);
    if (failure) {
        failure->message = fmt::format("{}: {}", path, failure->message);
        return failure;
    }
    if (data::write_all(STDOUT_FILENO, fmt::format("{}\n", part.shard))) return std::nullopt;
    return diag::Failure{Code::unwritable_output, "nobody waits for the parts any more"};
}

}  // namespace

std::optional<episodes::Sharing> sharing_of(const Request& whole) {
    const ShardRequest& request = whole.shard;
    if (request.shards == 0) return std::nullopt;
    episodes::Part part;
    part.etlc = library::kVersion;
    part.call = without(whole.words, {"--shard", "--part", "-j", "--jobs"});
    part.shard = request.shard;
    part.shards = request.shards;
    const char* const given = std::getenv("ETLC_CONTENTS");  // set by mpi.cpp for its ranks
    const std::string contents = given == nullptr ? "" : given;
    if (!request.from_input) return episodes::Sharing::shard(std::move(part), contents);
    return episodes::Sharing::shards(
        std::move(part), contents,
        {[shards = request.shards] { return next_shard(shards); },
         [folder = request.part](const episodes::Part& done) { return keep_part(folder, done); }});
}

std::vector<std::string> find_shared_episodes(episodes::Sharing* sharing,
                                              const std::vector<std::string>& data,
                                              const recordings::Chosen& chosen, diag::Sink& sink) {
    if (sharing != nullptr && sharing->merges()) return sharing->part().episodes;
    auto found = recordings::find_episodes(data, chosen, sink);
    if (sharing != nullptr) sharing->part().episodes = found;
    return found;
}

bool note_loaded(episodes::Sharing* sharing, std::vector<std::string> loaded, diag::Sink& sink) {
    if (sharing == nullptr) return true;
    std::sort(loaded.begin(), loaded.end());
    std::string hashes;
    for (const std::string& path : loaded)
        if (const auto hash = data::hash_of_file(path, Code::unreadable_part)) hashes += *hash;
    std::string& noted = sharing->part().loaded;
    if (!sharing->merges()) noted = hashes;
    if (noted == hashes) return true;
    sink.report({Code::part_of_another,
                 "the spec, a file that it loads or a table of labels has changed since the parts "
                 "were written"})
        .note("run the shards again, or merge with the files that they had");
    return false;
}

std::vector<std::string> merged_files(const episodes::Sharing* sharing) {
    return sharing == nullptr ? std::vector<std::string>{} : sharing->files();
}

bool is_shard(const episodes::Sharing* sharing) {
    return sharing != nullptr && !sharing->merges();
}

bool write_part(episodes::Sharing& sharing, const std::string& path, diag::Sink& sink) {
    if (sink.refused() || sharing.has_turns()) return !sink.refused();
    const episodes::Part& part = sharing.part();
    OutputFiles files(sink);
    return files.add(path, episodes::write(part)) &&
           files.add(
               std::string(kStandardOutput),
               fmt::format("shard {} of {}: {} of {}\n", part.shard, part.shards,
                           part.results.size(), diag::counted(part.episodes.size(), "episode"))) &&
           files.commit();
}

bool go_on_in_ranks(char** argv) {
    const auto is_several = [](const char* name) {
        const char* const ranks = std::getenv(name);
        return ranks != nullptr && std::atoi(ranks) > 1;
    };
    const std::string_view command = argv[1] == nullptr ? "" : argv[1];
    if (command != "calibrate" && command != "evaluate") return true;
    if (std::getenv("ETLC_RANK") != nullptr) return true;
    if (!is_several("OMPI_COMM_WORLD_SIZE") && !is_several("PMI_SIZE")) return true;
    for (char** word = argv; *word != nullptr; ++word)
        if (std::string_view(*word).starts_with("--shard")) return true;
    ::execv(data::helper_path("etlc-mpi").c_str(), argv);
    print_error(
        "etlc: this is one of several MPI ranks, and etlc-mpi, which shares the call out among "
        "them, cannot be run: install libopenmpi-dev and build etlc again\n");
    return false;
}

std::optional<episodes::Sharing> read_parts(const std::vector<std::string>& paths,
                                            diag::Sink& sink) {
    episodes::Joined all;
    for (const std::string& path : paths) {
        auto part = episodes::read_part(path);
        if (!part) {
            sink.report(data::in_file(part.failure(), path));
            return std::nullopt;
        }
        if (part->etlc != library::kVersion) {
            sink.report(data::in_file(
                {Code::part_of_another, fmt::format("was written by etlc {}, this is etlc {}",
                                                    part->etlc, library::kVersion)},
                path));
            return std::nullopt;
        }
        if (!all.add(std::move(*part), path, sink)) return std::nullopt;
    }
    if (!all.is_complete(sink)) return std::nullopt;
    return episodes::Sharing::merge(std::move(all), paths);
}

std::vector<std::string> merged_call(const episodes::Part& part, const std::string& output) {
    if (output.empty()) return part.call;
    const bool evaluates = part.call[0] == "evaluate";
    auto call = evaluates ? without(part.call, {"--json"}) : without(part.call, {"-o", "--output"});
    call.insert(call.end(), {evaluates ? "--json" : "--output", output});
    return call;
}

}  // namespace etlc::driver
