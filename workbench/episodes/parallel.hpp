// Reads several episodes at a time. The order of results and the failures reported do not depend on
// the number of threads. A thread that cannot be started, or runs out of memory, is done without as
// long as another works.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::episodes {

/// An error in an episode.
struct Fault {
    std::string path;
    diag::Failure failure;
};

/// Reports each kind of fault once, with the other episodes that have it, out of `episodes`.
void report(const std::vector<Fault>& faults, std::size_t episodes, diag::Sink& sink);

/// Returns the threads to use: as many as asked for (0: one per core), at most `most`.
std::size_t threads_for(unsigned asked, std::size_t most);

/// Runs `work` in this thread and in others: threads_for(), and no more than can be started.
/// Returns when all have ended, with the first exception that ended one of them.
std::exception_ptr in_threads(unsigned asked, std::size_t most, const std::function<void()>& work);

/// Reads all episodes: `make()` makes the reader of a thread, whose `score(path)` returns a
/// diag::Result<T>; `take(i, result)` gets each in the order of the paths, never two at once, and
/// few wait for their turn. Returns false after an error in some episode. Uses `jobs` and
/// `progress` of the request.
template <class T, class Request, class Make, class Take>
bool in_order(const std::vector<std::string>& paths, const Request& request, diag::Sink& sink,
              Make make, Take take) {
    constexpr std::size_t kMostWaiting = 8;
    std::atomic<std::size_t> next = 0;
    std::size_t turn = 0;
    std::map<std::size_t, diag::Result<T>> waiting;
    std::mutex taking;
    std::condition_variable moved;
    std::vector<Fault> faults;
    const auto take_next = [&] {
        auto result = std::move(waiting.begin()->second);
        waiting.erase(waiting.begin());
        const auto taken = data::within_memory([&]() -> diag::Result<bool> {
            if (!result) return result.failure();
            take(turn, std::move(*result));
            return true;
        });
        if (!taken) faults.push_back({paths[turn], taken.failure()});
        ++turn;
        if (request.progress) request.progress(turn, paths.size());
    };
    bool broken = false;  // a thread failed: its turn will not come
    const auto read = [&](auto& reader) {
        for (std::size_t i = next++; i < paths.size(); i = next++) {
            auto result = data::within_memory([&] { return reader.score(paths[i]); });
            std::unique_lock lock(taking);
            moved.wait(lock, [&] { return broken || turn == i || waiting.size() < kMostWaiting; });
            if (broken) return;
            waiting.emplace(i, std::move(result));
            while (!waiting.empty() && waiting.begin()->first == turn) take_next();
            moved.notify_all();
        }
    };
    const auto work = [&] {
        const auto reader = make();
        try {
            read(*reader);
        } catch (...) {
            const std::lock_guard lock(taking);
            broken = true;
            moved.notify_all();
            throw;
        }
    };
    const std::exception_ptr failure = in_threads(request.jobs, paths.size(), work);
    if (failure && turn < paths.size()) std::rethrow_exception(failure);
    report(faults, paths.size(), sink);
    return faults.empty();
}

/// Reads all episodes as in_order does, and returns all results.
template <class T, class Request, class Make>
std::optional<std::vector<T>> over_episodes(const std::vector<std::string>& paths,
                                            const Request& request, diag::Sink& sink, Make make) {
    std::vector<T> all;
    if (!in_order<T>(paths, request, sink, make,
                     [&](std::size_t, T&& one) { all.push_back(std::move(one)); }))
        return std::nullopt;
    return all;
}

}  // namespace etlc::episodes
