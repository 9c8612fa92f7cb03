// The examples' monitors for measurements: inputs are in buffers, as in a control loop. An example
// has a name, the generated Monitor, and fills its buffers with random numbers; `inputs` views
// them. BENCH_CLASSES distinguishes the classes with a flight recorder from those without.
#pragma once

#include <cstdint>
#include <random>

#include "belt.hpp"
#include "dock.hpp"
#include "dubins.hpp"
#include "example.hpp"
#include "gauge.hpp"
#include "grasp.hpp"
#include "hover.hpp"

namespace bench {
inline namespace BENCH_CLASSES {

using Random = std::mt19937;

template <class Buffer>
void fill(Buffer& buffer, Random& random, float mean, float spread) {
    std::normal_distribution<float> normal(mean, spread);
    for (auto& x : buffer) x = static_cast<std::remove_reference_t<decltype(x)>>(normal(random));
}

struct PaperExample {
    static constexpr const char* kName = "example: min l2, 2 x 2";
    using Monitor = example::Monitor;
    float z[2];
    explicit PaperExample(Random& random) { fill(z, random, 0.5F, 0.5F); }
    example::Inputs inputs() const { return {z}; }
};

struct Dubins {
    static constexpr const char* kName = "dubins: three min cosine, 32 x 8";
    using Monitor = dubins::Monitor;
    float z[32];
    explicit Dubins(Random& random) { fill(z, random, 0, 1); }
    dubins::Inputs inputs() const { return {z}; }
};

struct Dock {
    static constexpr const char* kName = "dock: min and kth cosine, 6 x 3";
    using Monitor = dock::Monitor;
    float z[6];
    bool called;
    explicit Dock(Random& random) : called(random() % 3 == 0) { fill(z, random, 0.25F, 1); }
    dock::Inputs inputs() const { return {z, called}; }
};

struct Hover {
    static constexpr const char* kName = "hover: min l2, 2 x 2, of scalars";
    using Monitor = hover::Monitor;
    float state[3];
    explicit Hover(Random& random) { fill(state, random, 0.5F, 0.5F); }
    hover::Inputs inputs() const { return {state[0], state[1], state[2]}; }
};

struct Belt {
    static constexpr const char* kName = "belt: l1 of float16, linf of int8";
    using Monitor = belt::Monitor;
    std::uint16_t a[16];
    std::int8_t b[16];
    explicit Belt(Random& random) {
        for (auto& x : a) x = static_cast<std::uint16_t>(0x3c00U + random() % 0x800U);  // in [1, 4)
        fill(b, random, 0, 32);
    }
    belt::Inputs inputs() const { return {a, b}; }
};

struct Gauge {
    static constexpr const char* kName = "gauge: mahalanobis, l2 in EXPR, 3 x 3";
    using Monitor = gauge::Monitor;
    float v[3], t;
    explicit Gauge(Random& random) : t(static_cast<float>(random() % 200) / 100) {
        fill(v, random, 0.75F, 1);
    }
    gauge::Inputs inputs() const { return {v, t}; }
};

struct Grasp {
    static constexpr const char* kName = "grasp: min l2, 384 x 4";
    using Monitor = grasp::Monitor;
    float z[384], force;
    explicit Grasp(Random& random) : force(static_cast<float>(random() % 400) / 100) {
        fill(z, random, 0, 1);
    }
    grasp::Inputs inputs() const { return {z, force}; }
};

}  // namespace BENCH_CLASSES
}  // namespace bench
