// min l2 over targets in float32, float16 and int8, in turns in one program: the gain of
// --targets-as, including its bounds; and the limit of widening: the time of only widening the rows
// to float32, in the registers of AVX-512. Finally, the time to widen narrow embeddings. Prints ns
// per call, medians, and the ratio to float32.
// Usage: bench_narrow [ROUNDS]
#include <time.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "aligned.hpp"
#include "etlmon/distance/enclosed.hpp"
#include "etlmon/distance/kernel.hpp"
#include "etlmon/distance/widen.hpp"
#include "median.hpp"

namespace {

using namespace etlmon;
using bench::median;
using detail::Fixed;

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr std::uint32_t kPoints = 16;

float doubtful(const Enclosed& e) {
    const Cut cuts[] = {0.5F};
    return e.doubtful(cuts) ? 0.0F : e.low;
}

/// Like a monitor: computes bounds, and whether a threshold is within them.
template <std::uint32_t D>
float enclosed(const Measured& measured) {
    return doubtful(enclose<L2>(measured, 0.01F, D));
}

#if defined(ETLMON_DISPATCH)
/// Widens rows without arithmetic: their bits are or-ed, so none can be omitted.
template <class G>
__attribute__((noinline, target("avx2,fma,avx512f,avx512vl,avx512bw,avx512dq"))) float widened_only(
    G rows, size_t n) {
    using namespace detail::x86_64_v4;
    WideBits a{}, b{}, c{}, d{};
    for (size_t i = 0; i + 4 * kWidth <= n; i += 4 * kWidth) {
        a |= reinterpret_cast<WideBits>(load(rows + i));
        b |= reinterpret_cast<WideBits>(load(rows + (i + kWidth)));
        c |= reinterpret_cast<WideBits>(load(rows + (i + 2 * kWidth)));
        d |= reinterpret_cast<WideBits>(load(rows + (i + 3 * kWidth)));
    }
    const WideBits all = a | b | c | d;
    float first = 0;
    detail::copy_bytes(&first, &all, sizeof first);
    return first;
}
bool can_widen() {
    return detail::x86_64_level() >= 4;
}
#else
template <class G>
float widened_only(G, size_t) {
    return 0;
}
bool can_widen() {
    return false;
}
#endif

template <std::uint32_t K, std::uint32_t D>
void compare(int rounds) {
    std::mt19937 random(K + D);
    std::normal_distribution<float> normal;
    bench::AlignedVector<float> z(kPoints * D), wide(std::size_t{K} * D);
    bench::AlignedVector<std::uint16_t> halves(wide.size());
    bench::AlignedVector<std::int8_t> bytes(wide.size());
    for (float& x : z) x = normal(random);
    for (std::size_t i = 0; i < wide.size(); ++i) {
        bytes[i] = static_cast<std::int8_t>(static_cast<int>(random() % 255) - 127);
        halves[i] = static_cast<std::uint16_t>(0x3800 + random() % 0x400 + (random() % 2) * 0x8000);
        wide[i] = detail::element(halves.data(), i);
    }
    const auto point = [&](std::uint32_t call) { return z.data() + call % kPoints * D; };
    const auto f32 = [&](std::uint32_t call) {
        return detail::best<L2, Min, Fixed<K, D>, false>(point(call), wide.data(), nullptr, {}, {})
            .delta;
    };
    const auto f16 = [&](std::uint32_t call) {
        return enclosed<D>(
            detail::best<L2, Min, Fixed<K, D>, false>(point(call), halves.data(), nullptr, {}, {}));
    };
    const auto i8 = [&](std::uint32_t call) {
        const detail::ScaledRows rows{bytes.data(), 0.01F};
        return enclosed<D>(
            detail::best<L2, Min, Fixed<K, D>, false>(point(call), rows, nullptr, {}, {}));
    };
    volatile float sink = 0;
    const auto f16_only = [&](std::uint32_t) {
        return widened_only(static_cast<const std::uint16_t*>(halves.data()), halves.size());
    };
    const auto i8_only = [&](std::uint32_t) {
        return widened_only(detail::ScaledRows{bytes.data(), 0.01F}, bytes.size());
    };
    std::vector<double> times[5];
    const std::uint32_t calls = std::max(1U, 40000000U / (K * D));
    const auto time = [&](const auto& kernel, std::vector<double>& into) {
        const double start = processor_seconds();
        for (std::uint32_t call = 0; call < calls; ++call) sink = kernel(call);
        into.push_back((processor_seconds() - start) * 1e9 / calls);
    };
    for (int round = 0; round < rounds; ++round) {
        time(f32, times[0]), time(f16, times[1]), time(i8, times[2]);
        if (can_widen()) time(f16_only, times[3]), time(i8_only, times[4]);
    }
    static_cast<void>(sink);
    const double of_f32 = median(times[0]), of_f16 = median(times[1]), of_i8 = median(times[2]);
    std::printf("%6u x %-6u %12.1f %12.1f %6.2f %12.1f %6.2f %12.1f %12.1f\n", D, K, of_f32, of_f16,
                of_f32 / of_f16, of_i8, of_f32 / of_i8, median(times[3]), median(times[4]));
    std::fflush(stdout);
}

/// Embeddings in narrow storage, widened before measuring.
template <std::uint32_t D>
void widen_embeddings(int rounds) {
    static std::uint16_t halves[D];
    static std::int8_t bytes[D];
    static float to[D];
    std::vector<double> times[2];
    constexpr std::uint32_t kCalls = 100000;
    const auto time = [&](const auto& widen, std::vector<double>& into) {
        const double start = processor_seconds();
        for (std::uint32_t call = 0; call < kCalls; ++call) {
            widen();
            __asm__ volatile("" ::"r"(to) : "memory");
        }
        into.push_back((processor_seconds() - start) * 1e9 / kCalls);
    };
    for (int round = 0; round < rounds; ++round) {
        time([] { widen_f16(halves, to, D); }, times[0]);
        time([] { widen_i8(bytes, 0.01F, to, D); }, times[1]);
    }
    std::printf("An embedding of %u elements to float32: %.1f from float16, %.1f from int8\n", D,
                median(times[0]), median(times[1]));
}

}  // namespace

int main(int argc, char** argv) {
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 25;
    std::printf("%-15s %12s %12s %6s %12s %6s %12s %12s\n", "D x K", "float32", "float16", "ratio",
                "int8", "ratio", "widen f16", "widen i8");
    compare<4, 384>(rounds);
    compare<16, 384>(rounds);
    compare<64, 384>(rounds);
    compare<64, 1000>(rounds);
    compare<1000, 384>(rounds);
    compare<10000, 384>(rounds);
    widen_embeddings<384>(rounds);
    return 0;
}
