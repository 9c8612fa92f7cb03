// What a step of a delay or a window costs, set against a plain recurrence acc = max(acc, x) of the same run and
// against a monotonic wedge, the usual structure for sliding maxima. Prints nanoseconds a step, worst single steps, and
// ratios. Every operator's state is in memory between steps, as in a monitor that is stepped from elsewhere.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "etlmon/window.hpp"

namespace {

using etlmon::Key;
using etlmon::max;
using etlmon::Span;
using etlmon::Value;

constexpr size_t kSamples = 1 << 16;

/// Robustness as a distance to a target wanders: a random walk that is drawn back.
std::vector<float> walk() {
    std::mt19937 random(1);
    std::normal_distribution<float> step;
    std::vector<float> samples(kSamples);
    float x = 0;
    for (float& sample : samples) sample = x = 0.99f * x + step(random);
    return samples;
}

/// Falls for as long as the longest window, then jumps: a wedge fills up and empties in one step.
std::vector<float> saw(size_t length) {
    std::vector<float> samples(length);
    for (size_t i = 0; i < length; ++i) samples[i] = -static_cast<float>(i % (length / 2));
    return samples;
}

Key made(float x, Key) {
    return etlmon::key_of(x);
}
Value made(float x, Value) {
    return etlmon::known(x);
}

/// The element of an operator from a sample, and the end of its result that a verdict reads.
template <class Element>
struct Sampled {
    static Element element(float x, float) { return made(x, Element{}); }
    static Element result(Element element) { return element; }
};
template <class V>
struct Sampled<Span<V>> {
    static Span<V> element(float x, float y) { return {made(x, V{}), made(y, V{})}; }
    static V result(Span<V> element) { return element.value; }
};

void keep(Key key) {
    benchmark::DoNotOptimize(key);
}
void keep(Value value) {
    benchmark::DoNotOptimize(value.low);
    benchmark::DoNotOptimize(value.high);
}

/// The recurrence of an unbounded operator.
template <class V>
struct Recurrence {
    using Element = V;
    V acc;
    void reset() { acc = etlmon::Lattice<V>::bottom(); }
    V push(V v) { return acc = max(acc, v); }
};
/// Sliding maximum by a queue of falling candidates: each value is stored once, but one step may drop all of them.
template <uint32_t N>
struct Wedge {
    using Element = Key;
    struct Candidate {
        Key key;
        uint32_t at;
    };
    std::vector<Candidate> ring = std::vector<Candidate>(N + 1);
    uint32_t head = 0, tail = 0, now = 0;
    static uint32_t after(uint32_t i) { return i == N ? 0 : i + 1; }
    static uint32_t before(uint32_t i) { return i == 0 ? N : i - 1; }
    void reset() { head = tail = now = 0; }
    Key push(Key key) {
        if (head != tail && now - ring[head].at == N) head = after(head);
        while (head != tail && ring[before(tail)].key <= key) tail = before(tail);
        ring[tail] = {key, now++};
        tail = after(tail);
        return ring[head].key;
    }
};

template <class V, uint32_t N>
struct DelayStep : etlmon::Delay<V, N> {
    using Element = V;
    void reset() { etlmon::Delay<V, N>::reset(etlmon::Lattice<V>::top()); }
};

template <class Operator>
void step(benchmark::State& state) {
    using Element = typename Operator::Element;
    std::vector<Element> stream;
    const std::vector<float> samples = walk();
    for (size_t i = 0; i < kSamples; ++i)
        stream.push_back(Sampled<Element>::element(samples[i], samples[(i + 7777) % kSamples]));
    const auto op = std::make_unique<Operator>();
    op->reset();
    benchmark::DoNotOptimize(op.get());
    size_t i = 0;
    for (auto _ : state) {
        keep(Sampled<Element>::result(op->push(stream[i++ % kSamples])));
        benchmark::ClobberMemory();
    }
}

double nanoseconds(std::chrono::steady_clock::duration time) {
    return std::chrono::duration<double, std::nano>(time).count();
}

/// The slowest step, less the cost of reading the clock. Each step is timed in several passes over the same stream and
/// its fastest time counts, so that what the machine does meanwhile does not.
template <class Operator>
double worst_step(uint32_t n) {
    using Element = typename Operator::Element;
    using Clock = std::chrono::steady_clock;
    const std::vector<float> samples = saw(4 * size_t{n});
    const auto op = std::make_unique<Operator>();
    std::vector<double> fastest(samples.size(), 1e9);
    double clock = 1e9;
    for (int pass = 0; pass < 25; ++pass) {
        op->reset();
        for (size_t i = 0; i < samples.size(); ++i) {
            const Element element = Sampled<Element>::element(samples[i], -samples[i]);
            benchmark::ClobberMemory();
            const Clock::time_point start = Clock::now();
            keep(Sampled<Element>::result(op->push(element)));
            benchmark::ClobberMemory();
            const Clock::time_point end = Clock::now();
            fastest[i] = std::min(fastest[i], nanoseconds(end - start));
            clock = std::min(clock, nanoseconds(Clock::now() - end));
        }
    }
    return *std::max_element(fastest.begin(), fastest.end()) - clock;
}

/// Passes results on to the console and remembers them for the ratios.
class Remembering : public benchmark::ConsoleReporter {
public:
    Remembering() : ConsoleReporter(OO_None) {}
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs)
            if (!run.error_occurred) cpu[run.run_name.function_name] = run.GetAdjustedCPUTime();
        ConsoleReporter::ReportRuns(runs);
    }
    std::map<std::string, double> cpu;
};

struct Row {
    std::string name;
    std::string peer;  ///< the recurrence over the same value type
    uint32_t n;
    uint32_t bytes;
    double (*worst)(uint32_t);
};
std::vector<Row> rows;

template <class Operator>
void add(const std::string& name, const std::string& peer, uint32_t n, uint32_t bytes) {
    benchmark::RegisterBenchmark(name.c_str(), step<Operator>);
    rows.push_back({name, peer, n, bytes, worst_step<Operator>});
}

template <class Operator, uint32_t N>
void add_sized(const std::string& name, const std::string& peer) {
    add<Operator>(name + '/' + std::to_string(N), peer, N, sizeof(Operator));
}

template <uint32_t N>
void add_length() {
    add<Wedge<N>>("wedge<Key>/" + std::to_string(N), "recurrence<Key>", N,
                  sizeof(typename Wedge<N>::Candidate) * (N + 1) + 12);
    add_sized<etlmon::Window<etlmon::Greatest<Key>, N>, N>("greatest<Key>", "recurrence<Key>");
    add_sized<etlmon::Window<etlmon::Greatest<Value>, N>, N>("greatest<Value>", "recurrence<Value>");
    add_sized<etlmon::Window<etlmon::Since<Key>, N>, N>("since<Key>", "recurrence<Key>");
    add_sized<etlmon::Window<etlmon::Since<Value>, N>, N>("since<Value>", "recurrence<Value>");
    add_sized<etlmon::Window<etlmon::Until<Key>, N>, N>("until<Key>", "recurrence<Key>");
    add_sized<etlmon::Window<etlmon::Until<Value>, N>, N>("until<Value>", "recurrence<Value>");
    add_sized<etlmon::Widening<etlmon::Greatest<Value>, N, 2 * N>, N>("widening<Value>", "recurrence<Value>");
    add_sized<DelayStep<Value, N>, N>("delay<Value>", "recurrence<Value>");
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RegisterBenchmark("recurrence<Key>", step<Recurrence<Key>>);
    benchmark::RegisterBenchmark("recurrence<Value>", step<Recurrence<Value>>);
    add_length<100>();
    add_length<1000>();
    add_length<1001>();
    add_length<10000>();
    add_length<100000>();
    Remembering reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);

    std::printf("\n%-24s %9s %12s %12s %12s %10s\n", "operator/length", "ns a step", "/ recurrence", "/ wedge",
                "worst, ns", "bytes");
    for (const Row& row : rows) {
        if (reporter.cpu.count(row.name) == 0) continue;
        const double time = reporter.cpu[row.name];
        const auto against = [&](const std::string& peer) {
            return reporter.cpu.count(peer) != 0 ? time / reporter.cpu[peer] : 0.0;
        };
        std::printf("%-24s %9.2f %12.2f %12.2f %12.0f %10u\n", row.name.c_str(), time, against(row.peer),
                    against("wedge<Key>/" + std::to_string(row.n)), row.worst(row.n), row.bytes);
    }
    return 0;
}
