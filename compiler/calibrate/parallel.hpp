// Episodes, several at a time.
// Takes: what reads one episode, a copy for every thread. Gives: what it made of each, in the order of the paths. Keeps
// true: the order, and which failures are reported, do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "calibrate/calibrate.hpp"
#include "data/file.hpp"

namespace etlc::calibrate {

inline constexpr std::size_t kMostReported = 10;  ///< of many files with the same fault

/// `make()` gives the reader of a thread, whose `score(path)` a diag::Result<T>. Nothing where an episode cannot be
/// read: the sink then says why.
template <class T, class Make>
std::optional<std::vector<T>> over_episodes(const std::vector<std::string>& paths, const Request& request,
                                            diag::Sink& sink, Make make) {
    std::vector<std::optional<diag::Result<T>>> results(paths.size());
    std::atomic<std::size_t> next = 0;
    std::size_t done = 0;
    std::mutex reporting;
    const auto work = [&] {
        const auto reader = make();
        for (std::size_t i = next++; i < paths.size(); i = next++) {
            results[i].emplace(reader->score(paths[i]));
            const std::lock_guard lock(reporting);
            ++done;
            if (request.progress) request.progress(done, paths.size());
        }
    };
    const std::size_t cores = std::max(1U, request.jobs > 0 ? request.jobs : std::thread::hardware_concurrency());
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < std::min(cores, paths.size()); ++i) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();

    std::vector<T> all;
    std::size_t failed = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (*results[i])
            all.push_back(std::move(**results[i]));
        else if (++failed <= kMostReported)
            sink.report(data::in_file(results[i]->failure(), paths[i]));
    }
    if (failed > 0) return std::nullopt;
    return all;
}

}  // namespace etlc::calibrate
