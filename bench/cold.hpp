// Times calls without their data in the caches.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace bench {

/// Fills the caches with other data, including the last level if it is not larger than `bytes`.
inline void sweep_caches() {
    constexpr std::size_t kBytes = std::size_t{128} << 20U;
    constexpr std::size_t kLine = 64;
    static std::vector<char> memory(kBytes, 1);
    for (std::size_t i = 0; i < kBytes; i += kLine) ++memory[i];
    asm volatile("" ::: "memory");
}

/// Returns the nanoseconds of a call with cold caches, without the cost of reading the clock.
template <class Call>
double cold_call(const Call& call) {
    using Clock = std::chrono::steady_clock;
    const auto timed = [](const auto& work) {
        asm volatile("" ::: "memory");
        const Clock::time_point start = Clock::now();
        work();
        asm volatile("" ::: "memory");
        return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    };
    sweep_caches();
    double clock = timed([] {});
    for (int i = 0; i < 20; ++i)
        clock = std::min(clock, timed([] {}));  // only the clock is warm again
    return timed(call) - clock;
}

}  // namespace bench
