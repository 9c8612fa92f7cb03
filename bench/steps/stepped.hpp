// An example's monitor with prepared inputs, to be stepped repeatedly.
#pragma once

#include <utility>
#include <vector>

#include "examples.hpp"

namespace bench {

constexpr std::size_t kSamples = 64;  ///< used in turn; small enough for the second-level cache

template <class Example>
struct SteppedExample {
    using Monitor = typename Example::Monitor;
    using Atoms = typename Monitor::Atoms;

    std::vector<Example> examples;
    std::vector<decltype(std::declval<Example>().inputs())> inputs;
    std::vector<Atoms> atoms;
    Monitor monitor;

    SteppedExample() {
        Random random(7);
        for (std::size_t i = 0; i < kSamples; ++i) examples.emplace_back(random);
        for (const Example& example : examples) inputs.push_back(example.inputs());
        monitor.reset();
        for (const auto& in : inputs) atoms.push_back(monitor.measure(in));
    }
    void step() {
        for (const auto& in : inputs) keep(monitor.step(in));
    }
    void measure() {
        for (const auto& in : inputs) keep(monitor.measure(in));
    }
    void judge() {
        for (const Atoms& now : atoms) keep(monitor.judge(now));
    }

private:
    template <class T>
    static void keep(const T& value) {
        asm volatile("" : : "r"(&value) : "memory");
    }
};

}  // namespace bench
