// Compares searching a large target set with measuring all of it: nanoseconds per step of both, in
// turns, and their ratio. Usage: bench_search [--rounds N] [--largest] (--largest: also 100 000
// rows of 768 elements, 307 MB). The rows are clouds of 50 around points along paths, like recorded
// demonstrations; each step draws a new embedding (incoherent), or the embedding walks, with steps
// that are a fraction of the distance between neighbouring rows.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "etlmon/distance/search.hpp"
#include "median.hpp"

namespace {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Free {
    void operator()(float* p) const { std::free(p); }
};

/// Rows with noise 1 in every element around centres with spread 3, or without centres.
template <std::uint32_t K, std::uint32_t D>
std::unique_ptr<float, Free> make_rows(bool clouds) {
    std::unique_ptr<float, Free> rows(
        static_cast<float*>(std::aligned_alloc(64, std::size_t{K} * D * sizeof(float))));
    std::mt19937 random(K + D);
    std::normal_distribution<float> normal;
    std::vector<float> center(D);
    for (std::uint32_t k = 0; k < K; ++k) {
        if (clouds && k % 50 == 0)
            for (float& x : center) x = 3 * normal(random);
        for (std::uint32_t i = 0; i < D; ++i)
            rows.get()[std::size_t{k} * D + i] = center[i] + normal(random);
    }
    return rows;
}

/// Embeddings of this many steps. `pace`: that of a walk around a middle row, in units of the rows'
/// noise; 0: drawn again each time.
template <std::uint32_t K, std::uint32_t D>
std::vector<float> make_trace(const float* rows, int steps, float pace) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::vector<float> z(rows + std::size_t{K / 2} * D, rows + std::size_t{K / 2 + 1} * D), trace;
    for (float& x : z) x += 0.5F * normal(random);
    for (int step = 0; step < steps; ++step) {
        for (float& x : z) x = pace > 0 ? x + pace * normal(random) : 3 * normal(random);
        trace.insert(trace.end(), z.begin(), z.end());
    }
    return trace;
}

void check(bool equal) {
    if (equal) return;
    std::fprintf(stderr, "the search is wrong\n");
    std::exit(1);
}

template <class Metric, std::uint32_t K, std::uint32_t D>
void measure(const char* metric, const float* rows, const char* about, float pace, int steps,
             int rounds) {
    const std::vector<float> trace = make_trace<K, D>(rows, steps, pace);
    const auto search = std::make_unique<etlmon::Search<K, D>>();
    std::vector<double> plain_ns, search_ns;
    for (int round = 0; round < rounds; ++round) {
        std::vector<etlmon::Measured> plain, found;
        plain.reserve(static_cast<std::size_t>(steps)),
            found.reserve(static_cast<std::size_t>(steps));
        double start = processor_seconds();
        for (int i = 0; i < steps; ++i)
            plain.push_back(etlmon::measure_stored<Metric, etlmon::Min, K, D>(
                trace.data() + i * std::ptrdiff_t{D}, rows));
        plain_ns.push_back((processor_seconds() - start) * 1e9 / steps);
        search->reset();
        start = processor_seconds();
        for (int i = 0; i < steps; ++i)
            found.push_back(
                search->template nearest<Metric>(trace.data() + i * std::ptrdiff_t{D}, rows));
        search_ns.push_back((processor_seconds() - start) * 1e9 / steps);
        check(std::memcmp(plain.data(), found.data(), plain.size() * sizeof(etlmon::Measured)) ==
              0);
    }
    const double a = bench::median(plain_ns), b = bench::median(search_ns);
    std::printf("%-7s %4u x %-7u %-34s %14.0f %14.0f %8.3f\n", metric, D, K, about, a, b, b / a);
    std::fflush(stdout);
}

template <std::uint32_t K, std::uint32_t D>
void measure(int steps, int rounds) {
    for (const bool clouds : {false, true}) {
        const auto rows = make_rows<K, D>(clouds);
        const std::string kind = clouds ? "clouds" : "one cloud";
        const auto both = [&](const std::string& about, float pace) {
            measure<etlmon::L2, K, D>("l2", rows.get(), (kind + ", " + about).c_str(), pace, steps,
                                      rounds);
            measure<etlmon::L1, K, D>("l1", rows.get(), (kind + ", " + about).c_str(), pace, steps,
                                      rounds);
        };
        both("drawn afresh", 0);
        both("walk, 0.3 a step", 0.3F);
        both("walk, 0.03 a step", 0.03F);
        both("walk, 0.003 a step", 0.003F);
    }
}

}  // namespace

int main(int argc, char** argv) {
    int rounds = 9;
    bool largest = false;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--largest") == 0) largest = true;
        if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
            rounds = std::max(1, std::atoi(argv[++i]));
    }
    std::printf("nanoseconds per step, median of %d rounds\n%-7s %-14s %-34s %14s %14s %8s\n",
                rounds, "min", "D x K", "rows, embedding", "all rows", "search", "ratio");
    measure<256, 384>(2000, rounds);
    measure<1000, 768>(500, rounds);
    measure<10000, 384>(100, rounds);
    if (largest) measure<100000, 768>(20, std::min(rounds, 3));
}
