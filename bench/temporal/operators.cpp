#include "operators.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "etlmon/temporal/widening.hpp"
#include "etlmon/temporal/window.hpp"
#include "signals.hpp"

namespace bench {

namespace {

using etlmon::Key;
using etlmon::max_of;
using etlmon::Span;
using etlmon::Value;

constexpr std::size_t kSamples = 1 << 15;

Key made(float x, Key) {
    return etlmon::key_of(x);
}
Value made(float x, Value) {
    return etlmon::between(x, x);
}

/// Makes the element of an operator from two samples, and takes the end of its result that a
/// verdict reads.
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

/// The recurrence of an unbounded operator.
template <class V>
struct Recurrence {
    using Element = V;
    V acc;
    void reset() { acc = etlmon::Lattice<V>::bottom(); }
    V push(V v) { return acc = max_of(acc, v); }
};

/// Sliding maximum by a queue of decreasing candidates: each value is stored once, but one step may
/// drop all of them.
template <uint32_t N>
struct Wedge {
    using Element = Key;
    struct Candidate {
        Key key;
        uint32_t at;
    };
    Candidate ring[N + 1];
    uint32_t head, tail, now;
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
[[gnu::noinline]] void steps(Operator& op, const typename Operator::Element* elements) {
    for (std::size_t i = 0; i < kSamples; ++i) {
        auto result = Sampled<typename Operator::Element>::result(op.push(elements[i]));
        asm volatile("" : : "r"(&result) : "memory");
    }
}

template <class Operator>
Routine routine() {
    using Element = typename Operator::Element;
    const auto op = std::make_shared<Operator>();
    const auto elements = std::make_shared<std::vector<Element>>();
    const std::vector<float> x = walk(kSamples, 1);
    const std::vector<float> y = walk(kSamples, 2);
    for (std::size_t i = 0; i < kSamples; ++i)
        elements->push_back(Sampled<Element>::element(x[i], y[i]));
    op->reset();
    return {"", [=] { steps(*op, elements->data()); }, kSamples};
}

template <class Operator>
double slowest(uint32_t n) {
    using Element = typename Operator::Element;
    const std::vector<float> samples = saw(4 * std::size_t{n}, 2 * std::size_t{n});
    const auto op = std::make_unique<Operator>();
    Element element{};
    const auto sample = [&](std::size_t i) {
        element = Sampled<Element>::element(samples[i], -samples[i]);
    };
    const auto step = [&] {
        auto result = Sampled<Element>::result(op->push(element));
        asm volatile("" : : "r"(&result) : "memory");
    };
    return worst_step(samples.size(), {[&] { op->reset(); }, sample, step});
}

struct Contender {
    std::string name;
    Routine routine;
    std::size_t bytes;
    double (*slowest)(uint32_t);
};

template <class Operator>
Contender contender(const std::string& name) {
    return {name, routine<Operator>(), sizeof(Operator), slowest<Operator>};
}

/// Measures the wedge first, over keys; the others are compared with it and with the recurrence.
template <uint32_t N>
std::vector<Contender> of_length() {
    return {contender<Wedge<N>>("wedge<Key>"),
            contender<etlmon::Window<etlmon::Greatest<Key>, N>>("Greatest<Key>"),
            contender<etlmon::Window<etlmon::Greatest<Value>, N>>("Greatest<Value>"),
            contender<etlmon::Window<etlmon::Since<Value>, N>>("Since<Value>"),
            contender<etlmon::Window<etlmon::Until<Key>, N>>("Until<Key>"),
            contender<etlmon::Window<etlmon::Until<Value>, N>>("Until<Value>"),
            contender<etlmon::Widening<etlmon::Greatest<Value>, N, 2 * N>>("Widening<Value>"),
            contender<DelayStep<Value, N>>("Delay<Value>")};
}

template <uint32_t N>
void measure_length(const std::string& only, Effort effort, nlohmann::json& all) {
    const std::vector<Contender> contenders = of_length<N>();
    std::vector<Routine> routines{routine<Recurrence<Value>>()};
    std::vector<const Contender*> chosen;
    for (const Contender& one : contenders) {
        if (&one != contenders.data() && one.name.find(only) == std::string::npos) continue;
        chosen.push_back(&one);
        routines.push_back(one.routine);
    }
    const std::vector<Series> series = measure(routines, effort);
    for (std::size_t c = 0; c < chosen.size(); ++c) {
        const Series& own = series[c + 1];
        all.push_back({{"operator", chosen[c]->name + " over " + std::to_string(N)},
                       {"ns", own.median()},
                       {"spread_percent", 100 * own.spread()},
                       {"to_recurrence", ratio(own, series[0])},
                       {"to_wedge", ratio(own, series[1])},
                       {"worst_step_ns", chosen[c]->slowest(N)},
                       {"state_bytes", chosen[c]->bytes}});
        std::printf("%-16s %7u %8.2f %4.0f %13.2f %8.2f %10.0f %9zu\n", chosen[c]->name.c_str(), N,
                    own.median(), 100 * own.spread(), ratio(own, series[0]), ratio(own, series[1]),
                    all.back()["worst_step_ns"].get<double>(), chosen[c]->bytes);
        std::fflush(stdout);
    }
}

}  // namespace

nlohmann::json measure_operators(const std::string& only, Effort effort) {
    std::printf("%-16s %7s %8s %4s %13s %8s %10s %9s\n", "operator", "length", "ns", "+- %",
                "/ recurrence", "/ wedge", "worst, ns", "bytes");
    nlohmann::json all = nlohmann::json::array();
    measure_length<100>(only, effort, all);
    measure_length<1000>(only, effort, all);
    measure_length<10000>(only, effort, all);
    measure_length<100000>(only, effort, all);
    return all;
}

}  // namespace bench
