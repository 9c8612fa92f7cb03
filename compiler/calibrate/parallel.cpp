#include "calibrate/parallel.hpp"

#include <algorithm>
#include <new>
#include <system_error>
#include <thread>

namespace etlc::calibrate {

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
    const std::size_t wanted =
        std::max(1U, asked > 0 ? asked : std::thread::hardware_concurrency());
    const std::size_t threads = std::min(wanted, most);
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

}  // namespace etlc::calibrate
