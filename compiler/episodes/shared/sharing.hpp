// A call whose episodes are shared out among processes.
// Takes: a shard's number, or all parts of a call. Gives: of a shard, its part; of all parts, what
// one process would have made of each episode. Keeps true: what comes after the reading of episodes
// is done once, over all of them in the order of the call, so it gives the bytes of one process.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "data/spill/pack.hpp"
#include "episodes/parallel.hpp"
#include "episodes/recording.hpp"
#include "episodes/shared/contents.hpp"
#include "episodes/shared/part.hpp"

namespace etlc::episodes {

class Sharing {
public:
    /// One shard: `part` says which, and of what call. `contents`: as contents_of takes it.
    static Sharing shard(Part part, std::string contents) {
        Sharing result(std::move(part), false);
        result.contents_ = std::move(contents);
        return result;
    }
    /// All of them, from these files.
    static Sharing merge(Joined all, std::vector<std::string> files) {
        Sharing result(all.call(), true);
        result.all_ = std::move(all);
        result.files_ = std::move(files);
        return result;
    }

    bool merges() const { return merges_; }
    Part& part() { return part_; }
    /// Where parts are merged: what was made of an episode.
    std::string result(std::size_t place) const { return all_.result(place); }
    /// What is merged, which no result may be written over.
    const std::vector<std::string>& files() const { return files_; }
    /// The file in which processes keep by what episodes are shared out; empty: none.
    const std::string& contents() const { return contents_; }

private:
    Sharing(Part part, bool merges) : part_(std::move(part)), merges_(merges) {}

    Part part_;
    Joined all_;
    bool merges_;
    std::vector<std::string> files_;
    std::string contents_;
};

/// As labelled_in of the first episode; where parts are merged, from them. Nothing where the sink
/// now says why. Of the request it uses `episodes`, `names` and `sharing`.
template <class Request>
std::optional<std::vector<Index>> labelled_in_first(const check::Model& model,
                                                    const Request& request, diag::Sink& sink) {
    if (request.sharing != nullptr && request.sharing->merges())
        return request.sharing->part().labelled;
    auto labelled = labelled_in(model, request.episodes.front(), request.names);
    if (!labelled) {
        sink.report(data::in_trace(labelled.failure(), request.episodes.front()));
        return std::nullopt;
    }
    if (request.sharing != nullptr) request.sharing->part().labelled = *labelled;
    return std::move(*labelled);
}

/// As in_order. Of a shard only its own are read, their results go into its part, and none is
/// taken; where parts are merged, nothing is read. Whether all were taken; where not, and this is
/// no shard, the sink now says why.
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
    std::vector<std::size_t> places;
    std::vector<std::string> own;
    const auto contents = contents_of(paths, request.sharing->contents());
    for (std::size_t place = 0; place < paths.size(); ++place) {
        if (shard_of(contents[place], part.shards) != part.shard) continue;
        places.push_back(place);
        own.push_back(paths[place]);
    }
    in_order<T>(own, request, sink, make, [&](std::size_t i, const T& result) {
        part.results.emplace(places[i], data::packed(result));
    });
    return false;
}

}  // namespace etlc::episodes
