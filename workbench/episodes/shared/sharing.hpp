// Distributes the episodes of a call among processes: a shard reads its own into a part, and a
// merge has the results of all parts. Everything after the reading is done once, over all episodes
// in the order of the call, so the output has the bytes of a single process.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "data/spill/spill.hpp"
#include "diag/diag.hpp"
#include "episodes/parallel.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

// ---- parts of shards ----------------------------------------------------------------------------
// A part of a result: the file that one shard of a call makes of its episodes. Detects files that
// were truncated or changed, parts of different calls or data, and missing or repeated shards.

inline constexpr std::uint32_t kMostShards = 1'000'000;

struct Part {
    std::string etlc;               ///< version of etlc
    std::vector<std::string> call;  ///< arguments from the command on, without the shard
    std::string loaded;             ///< hash of the spec and of all files that it loads
    std::uint32_t shard = 0;        ///< 1 to `shards`
    std::uint32_t shards = 0;
    std::vector<std::string> episodes;   ///< all episodes of the call, in order
    std::vector<check::Index> labelled;  ///< labelled predicates, according to the first episode
    std::map<std::uint64_t, std::string> results;  ///< packed, by place in `episodes`
};

template <class Archive>
void fields(Archive& archive, Part& part) {
    archive(part.etlc, part.call, part.loaded, part.shard, part.shards, part.episodes,
            part.labelled, part.results);
}

/// Returns the shard, 1 to `shards`, that reads an episode of this content.
constexpr std::uint32_t shard_of(std::uint64_t content, std::uint32_t shards) {
    return static_cast<std::uint32_t>(content % shards) + 1;
}

std::string write(const Part& part);
/// Wraps a packed part as a file.
std::string as_file(std::string_view body);
/// Reads a part. Failures are E1101 and E1102, and do not repeat the path.
diag::Result<Part> read_part(const std::string& path);
diag::Result<Part> parse_part(std::string_view bytes);

/// Joins the shards of a call, in any order; results stay out of memory.
class Joined {
public:
    /// Adds a shard; `path` is for messages. Returns false after reporting that it belongs to
    /// another call, E1103, or is repeated, E1104.
    bool add(Part part, const std::string& path, diag::Sink& sink);
    /// Returns false after reporting a missing shard or episode, E1104.
    bool is_complete(diag::Sink& sink) const;

    /// Returns the call, without results.
    const Part& call() const { return call_; }
    /// Returns the packed result of an episode by its place.
    std::string result(std::size_t place) const { return results_[at_[place]]; }

private:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    Part call_;                                    ///< from the first shard
    std::string first_;                            ///< path of the first shard
    std::map<std::uint32_t, std::string> shards_;  ///< paths by number of the shard
    std::vector<std::uint32_t> at_;                ///< index of the result, by place
    data::Spool<std::string> results_;
};

// Episodes are distributed by a number of their content, so neither names of files nor their order
// matter. Processes that share a file of these numbers read each episode once between them.

/// Returns a hash of the size of the episode's file, its first and last 4 KiB and the group in it.
/// The end of an .npz file has checksums of its arrays.
std::uint64_t content_of(const std::string& episode);

/// Returns the numbers of all episodes, in order. `cache`: a file to read them from, or to write
/// them to; empty: none.
std::vector<std::uint64_t> contents_of(const std::vector<std::string>& episodes,
                                       const std::string& cache);

// ---- calls that share the reading ---------------------------------------------------------------

class Sharing {
public:
    /// For a process that makes several shards: returns the next one, and stores a complete part.
    struct Turns {
        std::function<std::optional<std::uint32_t>()> next;
        std::function<std::optional<diag::Failure>(const Part&)> keep;
    };

    /// Makes one shard, described by `part`. `contents`: see contents_of.
    static Sharing shard(Part part, std::string contents) {
        Sharing result(std::move(part), false);
        result.contents_ = std::move(contents);
        return result;
    }
    /// Makes several shards in turn.
    static Sharing shards(Part part, std::string contents, Turns turns) {
        Sharing result = shard(std::move(part), std::move(contents));
        result.turns_ = std::move(turns);
        return result;
    }
    /// Merges all parts, from these files.
    static Sharing merge(Joined all, std::vector<std::string> files) {
        Sharing result(all.call(), true);
        result.all_ = std::move(all);
        result.files_ = std::move(files);
        return result;
    }

    bool merges() const { return merges_; }
    bool has_turns() const { return turns_.next != nullptr; }
    /// Begins the next shard, with `part()` empty; returns false where none is left.
    bool begin_shard() {
        if (!has_turns()) return !std::exchange(has_begun_, true);
        const auto next = turns_.next();
        part_.results.clear();
        part_.shard = next.value_or(0);
        return next.has_value();
    }
    /// Stores the complete part.
    std::optional<diag::Failure> end_shard() const {
        return has_turns() ? turns_.keep(part_) : std::nullopt;
    }
    Part& part() { return part_; }
    /// Returns the merged result of an episode.
    std::string result(std::size_t place) const { return all_.result(place); }
    /// Returns the merged files, which no output may overwrite.
    const std::vector<std::string>& files() const { return files_; }
    /// Returns the file that keeps the numbers of contents; empty: none.
    const std::string& contents() const { return contents_; }

private:
    Sharing(Part part, bool merges) : part_(std::move(part)), merges_(merges) {}

    Part part_;
    Joined all_;
    bool merges_;
    bool has_begun_ = false;
    Turns turns_;
    std::vector<std::string> files_;
    std::string contents_;
};

/// Returns the labelled predicates of the first episode, or those of the merged parts. Returns
/// nothing after an error. Uses `episodes`, `names` and `sharing` of the request.
template <class Request>
std::optional<std::vector<Index>> labelled_in_first(const check::Model& model,
                                                    const Request& request, diag::Sink& sink) {
    if (request.sharing != nullptr && request.sharing->merges())
        return request.sharing->part().labelled;
    auto labelled = labelled_in(model, request.episodes.front(), request.reading);
    if (!labelled) {
        sink.report(recordings::in_trace(labelled.failure(), request.episodes.front()));
        return std::nullopt;
    }
    if (request.sharing != nullptr) request.sharing->part().labelled = *labelled;
    return std::move(*labelled);
}

/// Reads episodes as in_order does. A shard reads only its own, into its part, and `take` gets
/// none; a merge reads nothing. Returns whether `take` got all; if not, an error was reported or
/// this is a shard.
template <class T, class Request, class Make, class Take>
bool over_shared_episodes(const std::vector<std::string>& paths, const Request& request,
                          diag::Sink& sink, Make make, Take take) {
    if (request.sharing == nullptr) return in_order<T>(paths, request, sink, make, take);
    Part& part = request.sharing->part();
    if (request.sharing->merges()) {
        for (std::size_t place = 0; place < paths.size(); ++place) {
            auto result = data::unpacked<T>(request.sharing->result(place));
            if (!result) {
                sink.report(data::in_file(
                    {diag::Code::damaged_part, "its result is not one of this version of etlc"},
                    paths[place]));
                return false;
            }
            take(place, std::move(*result));
        }
        return true;
    }
    const auto contents = contents_of(paths, request.sharing->contents());
    while (request.sharing->begin_shard()) {
        std::vector<std::size_t> places;
        std::vector<std::string> own;
        for (std::size_t place = 0; place < paths.size(); ++place) {
            if (shard_of(contents[place], part.shards) != part.shard) continue;
            places.push_back(place);
            own.push_back(paths[place]);
        }
        if (!in_order<T>(own, request, sink, make, [&](std::size_t i, const T& result) {
                part.results.emplace(places[i], data::packed(result));
            }))
            return false;
        if (const auto failure = request.sharing->end_shard()) {
            sink.report({failure->code, failure->message});
            return false;
        }
    }
    return false;
}

}  // namespace etlc::episodes
