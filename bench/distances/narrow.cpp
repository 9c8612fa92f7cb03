// min l2 over targets in float32, float16 and int8, in one program and by turns: what --targets-as gains, without and
// with the bounds that it needs. Prints ns per call, medians, and the ratio to float32. Usage: bench_narrow [ROUNDS]
#include <time.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "etlmon/enclosed.hpp"

namespace {

using namespace etlmon;
using detail::Fixed;

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr std::uint32_t kPoints = 16;

/// What a monitor does with a distance: bounds, and whether a threshold lies within them.
template <std::uint32_t D>
float enclosed(const Measured& measured) {
    const Enclosed e = enclose<L2>(measured, 0.01F, D);
    const Cut cuts[] = {0.5F};
    return e.doubtful(cuts) ? 0.0F : e.low;
}

template <std::uint32_t K, std::uint32_t D>
void compare(int rounds) {
    std::mt19937 random(K + D);
    std::normal_distribution<float> normal;
    std::vector<float> z(kPoints * D), wide(std::size_t{K} * D);
    std::vector<std::uint16_t> halves(wide.size());
    std::vector<std::int8_t> bytes(wide.size());
    for (float& x : z) x = normal(random);
    for (std::size_t i = 0; i < wide.size(); ++i) {
        bytes[i] = static_cast<std::int8_t>(static_cast<int>(random() % 255) - 127);
        halves[i] = static_cast<std::uint16_t>(0x3800 + random() % 0x400 + (random() % 2) * 0x8000);
        wide[i] = detail::element(halves.data(), i);
    }
    const auto point = [&](std::uint32_t call) { return z.data() + call % kPoints * D; };
    const auto f32 = [&](std::uint32_t call) {
        return detail::best<L2, Min, Fixed<K, D>, false>(point(call), wide.data(), nullptr, {}, {}).delta;
    };
    const auto f16 = [&](std::uint32_t call) {
        return enclosed<D>(detail::best<L2, Min, Fixed<K, D>, false>(point(call), halves.data(), nullptr, {}, {}));
    };
    const auto i8 = [&](std::uint32_t call) {
        const detail::ScaledRows rows{bytes.data(), 0.01F};
        return enclosed<D>(detail::best<L2, Min, Fixed<K, D>, false>(point(call), rows, nullptr, {}, {}));
    };
    volatile float sink = 0;
    std::vector<double> times[3];
    const std::uint32_t calls = std::max(1U, 40000000U / (K * D));
    const auto time = [&](const auto& kernel, std::vector<double>& into) {
        const double start = processor_seconds();
        for (std::uint32_t call = 0; call < calls; ++call) sink = kernel(call);
        into.push_back((processor_seconds() - start) * 1e9 / calls);
    };
    for (int round = 0; round < rounds; ++round) time(f32, times[0]), time(f16, times[1]), time(i8, times[2]);
    static_cast<void>(sink);
    for (auto& t : times) std::nth_element(t.begin(), t.begin() + rounds / 2, t.end());
    const double of_f32 = times[0][rounds / 2], of_f16 = times[1][rounds / 2], of_i8 = times[2][rounds / 2];
    std::printf("%6u x %-6u %12.1f %12.1f %6.2f %12.1f %6.2f\n", D, K, of_f32, of_f16, of_f32 / of_f16, of_i8,
                of_f32 / of_i8);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 25;
    std::printf("%-15s %12s %12s %6s %12s %6s\n", "D x K", "float32", "float16", "ratio", "int8", "ratio");
    compare<4, 384>(rounds);
    compare<16, 384>(rounds);
    compare<64, 384>(rounds);
    compare<64, 1000>(rounds);
    compare<1000, 384>(rounds);
    compare<10000, 384>(rounds);
    return 0;
}
