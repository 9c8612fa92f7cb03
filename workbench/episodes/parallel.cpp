#include "episodes/parallel.hpp"

#include <fmt/format.h>

#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "data/text/text.hpp"
#include "recordings/open.hpp"

namespace etlc::episodes {

void report(const std::vector<Fault>& faults, std::size_t episodes, diag::Sink& sink) {
    constexpr std::size_t kMostKinds = 10;
    struct Kind {
        diag::Failure failure;
        std::vector<std::string> paths;
    };
    std::vector<Kind> kinds;  // in the order of the first of each
    std::map<std::pair<diag::Code, std::string>, std::size_t> known;
    for (const auto& [path, failure] : faults) {
        const auto [at, is_new] = known.try_emplace({failure.code, failure.message}, kinds.size());
        if (is_new) kinds.push_back({failure, {}});
        kinds[at->second].paths.push_back(path);
    }
    std::size_t reported = 0;
    for (std::size_t i = 0; i < std::min(kinds.size(), kMostKinds); ++i) {
        const auto& [failure, paths] = kinds[i];
        reported += paths.size();
        auto& error = sink.report(recordings::in_trace(failure, paths.front()));
        if (paths.size() > 1)
            error.note(fmt::format("the same is wrong with {} of {} episodes, also with {}",
                                   paths.size(), episodes,
                                   data::listed({paths.begin() + 1, paths.end()})));
        if (i + 1 == kMostKinds && reported < faults.size())
            error.note(fmt::format("of {} episodes, {} more are wrong in other ways", episodes,
                                   faults.size() - reported));
    }
}

std::size_t threads_for(unsigned asked, std::size_t most) {
    const std::size_t wanted =
        std::max(1U, asked > 0 ? asked : std::thread::hardware_concurrency());
    return std::min(wanted, most);
}

std::exception_ptr in_threads(unsigned asked, std::size_t most, const std::function<void()>& work) {
    std::exception_ptr first;
    std::mutex ending;
    const auto guarded = [&] {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(ending);
            if (!first) first = std::current_exception();
        }
    };
    const std::size_t threads = threads_for(asked, most);
    std::vector<std::thread> others;
    try {
        if (threads > 1) others.reserve(threads - 1);
        while (others.size() + 1 < threads) others.emplace_back(guarded);
    } catch (const std::system_error&) {  // the system allows no more threads
    } catch (const std::bad_alloc&) {     // nor does memory
    }
    guarded();
    for (std::thread& other : others) other.join();
    return first;
}

}  // namespace etlc::episodes
