// min l2 over K targets: nanoseconds per call of every contestant in every cell, in one run, and
// the important ratios. Usage: bench_distances [--json FILE] [--rounds N] [--cold] Contestants take
// turns within each round, so changes of the machine's speed affect all of them; the result is the
// median of processor time over the rounds. Answers are compared first: a wrong contestant is an
// error, not a result.
// --cold: a turn is one call with cold caches, in wall-clock time.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <random>
#include <string>

#include "aligned.hpp"
#include "cells.hpp"
#include "cold.hpp"
#include "median.hpp"

namespace {

using namespace bench;

/// A set of targets and points among them, 64-byte aligned.
class Data {
public:
    explicit Data(Cell cell) : cell_(cell) {
        std::mt19937 random(cell.dimension * 31 + cell.rows);
        std::normal_distribution<float> normal;
        targets_ = make(std::size_t{cell.rows} * cell.dimension, [&] { return normal(random); });
        points_ = make(std::size_t{Points::kNumber} * stride(), [&] { return normal(random); });
    }
    const float* targets() const { return targets_.data(); }
    Points points() const { return {points_.data(), stride()}; }

private:
    using Floats = AlignedVector<float>;

    std::size_t stride() const { return (cell_.dimension + 15) / 16 * 16; }
    template <class Draw>
    static Floats make(std::size_t n, const Draw& draw) {
        Floats floats(n);
        std::generate(floats.begin(), floats.end(), draw);
        return floats;
    }

    Cell cell_;
    Floats targets_, points_;
};

double exact(const Data& data, Cell cell, std::uint32_t point) {
    const float* z = data.points()[point];
    double least = HUGE_VAL;
    for (std::uint32_t k = 0; k < cell.rows; ++k) {
        double sum = 0;
        for (std::uint32_t i = 0; i < cell.dimension; ++i) {
            const double d =
                double{z[i]} - double{data.targets()[std::size_t{k} * cell.dimension + i]};
            sum += d * d;
        }
        least = std::min(least, sum);
    }
    return std::sqrt(least);
}

/// The processor time of this thread, which excludes other work on the machine as far as possible.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds(const Entry& entry, const Data& data, const void* state, std::uint64_t calls) {
    const double start = processor_seconds();
    entry.repeat(data.points(), data.targets(), state, calls);
    return processor_seconds() - start;
}

struct Competitor {
    std::string name;
    Entry entry;
    const void* state;
    std::uint64_t calls;
    std::vector<double> rounds;  ///< ns per call
};

double warm_ns(const Competitor& c, const Data& data) {
    return seconds(c.entry, data, c.state, c.calls) * 1e9 / static_cast<double>(c.calls);
}

double cold_ns(const Competitor& c, const Data& data, const float* point) {
    volatile float sink = 0;
    return cold_call([&] { sink = c.entry.nearest(point, data.targets(), c.state); });
}

/// ns per call of every contestant, median over the rounds.
std::map<std::string, double> measure(Cell cell, const std::vector<Contestant>& contestants,
                                      int rounds, bool cold) {
    const Data data(cell);
    std::vector<Competitor> competitors;
    for (const Contestant& c : contestants) {
        const auto entry = std::find_if(c.entries.begin(), c.entries.end(), [&](const Entry& e) {
            return e.cell.dimension == cell.dimension && e.cell.rows == cell.rows;
        });
        const void* state =
            c.setup != nullptr ? c.setup(data.targets(), cell.rows, cell.dimension) : nullptr;
        for (std::uint32_t i = 0; i < Points::kNumber && c.name != std::string("read floor"); ++i) {
            const double got = entry->nearest(data.points()[i], data.targets(), state),
                         want = exact(data, cell, i);
            if (std::abs(got - want) > 1e-3 * want) {
                std::fprintf(stderr, "%s at %u x %u: %g, expected %g\n", c.name, cell.dimension,
                             cell.rows, got, want);
                std::exit(1);
            }
        }
        std::uint64_t calls = 1;
        constexpr double kRound = 2e-3;
        while (!cold && seconds(*entry, data, state, calls) < kRound) calls *= 2;
        competitors.push_back({c.name, *entry, state, calls, {}});
    }
    for (int round = 0; round < rounds; ++round) {
        const float* point = data.points()[static_cast<std::size_t>(round)];
        for (Competitor& c : competitors)
            c.rounds.push_back(cold ? cold_ns(c, data, point) : warm_ns(c, data));
    }
    std::map<std::string, double> medians;
    for (const Competitor& c : competitors) medians[c.name] = median(c.rounds);
    return medians;
}

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown";
}

}  // namespace

int main(int argc, char** argv) {
    std::string json;
    int rounds = 15;
    bool cold = false;
    CLI::App app{"The smallest of K distances, by ours and by peers."};
    app.add_option("--json", json, "writes the figures there too");
    app.add_option("--rounds", rounds, "figures are medians over them")->check(CLI::PositiveNumber);
    app.add_flag("--cold", cold, "calls that find nothing in the caches");
    CLI11_PARSE(app, argc, argv);
    const std::vector<Contestant> ours {
        etlmon_gxx(), etlmon_gxx_native(),
#if defined(ETLC_BENCH_CLANG)
            etlmon_clang(), etlmon_clang_native()
#endif
    };
    const std::vector<Contestant> peers{eigen_gemv(), eigen_direct(), openblas(), highway()};
    std::vector<Contestant> all{read_floor(), naive_O2(), naive_O3_native()};
    all.insert(all.end(), peers.begin(), peers.end());
    all.insert(all.end(), ours.begin(), ours.end());

    std::printf(
        "min l2 over K targets of D float32, ns per call, %s caches, median of %d rounds; %s\n",
        cold ? "cold" : "warm", rounds, cpu_name().c_str());
    std::printf("%-11s", "D x K");
    for (const Contestant& c : all) std::printf(" %16s", c.name);
    std::printf(" | of ours, the slowest: / best peer, floor /\n");
    std::string rows;
    for (const Cell cell : {
#define CELL(D, K) Cell{D, K},
             ETLC_BENCH_CELLS(CELL)
#undef CELL
         }) {
        std::map<std::string, double> ns = measure(cell, all, rounds, cold);
        const std::string name = std::to_string(cell.dimension) + " x " + std::to_string(cell.rows);
        std::printf("%-11s", name.c_str());
        std::string results;
        for (const Contestant& c : all) {
            std::printf(" %16.1f", ns[c.name]);
            results += (results.empty() ? "" : ", ") + ('"' + std::string(c.name)) +
                       "\": " + std::to_string(ns[c.name]);
        }
        double best = HUGE_VAL, slowest = 0;
        for (const Contestant& c : peers) best = std::min(best, ns[c.name]);
        for (const Contestant& c : ours) slowest = std::max(slowest, ns[c.name]);
        std::printf(" | %22.2f %8.2f\n", slowest / best, ns["read floor"] / slowest);
        std::fflush(stdout);
        rows += (rows.empty() ? "" : ",\n") + ("  {\"cell\": \"" + name) + "\", " + results + "}";
    }
    if (!json.empty()) {
        std::ofstream out(json);
        out << "[\n" << rows << "\n]\n";
        if (!out.flush()) return 1;
    }
    return 0;
}
