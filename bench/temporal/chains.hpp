// Chains of 24 phases: the generated class beside one register a phase by hand, as in cases.hpp.
// The signals take turns, and the thresholds rise, so that all phases differ.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cases.hpp"
#include "chain_24.hpp"
#include "plain.hpp"
#include "signals.hpp"
#include "until_24.hpp"

namespace bench {

constexpr int kPhases = 24;

/// Robustness by hand: signal k % 3 against the threshold of phase k.
struct PhasesByHand {
    float signals[3];
    PhasesByHand(const Signals& s, std::size_t i) : signals{s.p[i], s.q[i], s.r[i]} {}
    float operator[](int k) const { return signals[k % 3] - static_cast<float>(k / 3) * 0.125F; }
};

template <class Generated, class GeneratedInputs>
struct ChainOfThree {
    using Monitor = Generated;
    static constexpr uint32_t kWindow = 1;
    static constexpr std::size_t kMonitors = 1;
    template <class Inputs = GeneratedInputs>
    static Inputs inputs(const Signals& signals, std::size_t i) {
        return {signals.p[i], signals.q[i], signals.r[i]};
    }
    template <class Verdicts, class Visit>
    static void visit(const Verdicts& verdicts, const Visit& take) {
        take(0, verdicts.m);
    }
    using Rescanning = NoRescanning;
};

struct Chain24 : ChainOfThree<chain_24::Monitor, chain_24::Inputs> {
    static constexpr const char* kTitle = "F (p && F (q && ...)), 24 phases";
    struct Plain {
        float reached[kPhases];
        void reset() {
            for (float& phase : reached) phase = -kInfinity;
        }
        void step(const Signals& s, std::size_t i, float* rho) {
            const PhasesByHand now(s, i);
            float before = kInfinity;
            for (int k = 0; k < kPhases; ++k)
                before = reached[k] = larger(reached[k], smaller(before, now[k]));
            *rho = before;
        }
    };
};

struct Until24 : ChainOfThree<until_24::Monitor, until_24::Inputs> {
    static constexpr const char* kTitle = "p U (q U (...)), 24 phases";
    struct Plain {
        float holds[kPhases - 1];  ///< each left side, so far
        float met;
        void reset() {
            for (float& phase : holds) phase = -kInfinity;
            holds[0] = kInfinity;
            met = -kInfinity;
        }
        void step(const Signals& s, std::size_t i, float* rho) {
            const PhasesByHand now(s, i);
            float open = -kInfinity;
            for (int k = 0; k < kPhases - 1; ++k) {
                open = larger(open, holds[k]);
                holds[k] = smaller(open, now[k]);
            }
            *rho = met = larger(met, smaller(open, now[kPhases - 1]));
        }
    };
};

}  // namespace bench
