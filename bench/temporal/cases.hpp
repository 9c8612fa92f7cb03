// The measured formulas: the generated class beside hand-written code.
// A case has a title, the generated Monitor, the longest window, a function that fills its inputs
// from signals, the number of its monitors and a visitor for their verdicts, and Plain: robustness
// by hand; if there is a window, also Rescanning, which goes through each window at each step, as
// simple monitors do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "always_1000.hpp"
#include "always_eventually_50.hpp"
#include "always_until_100.hpp"
#include "change_10.hpp"
#include "count_50.hpp"
#include "eventually_100000.hpp"
#include "eventually_50.hpp"
#include "eventually_always_1000.hpp"
#include "invariant.hpp"
#include "machine.hpp"
#include "machine_small.hpp"
#include "mean_50.hpp"
#include "nested.hpp"
#include "nested_bounds.hpp"
#include "one.hpp"
#include "plain.hpp"
#include "response_50.hpp"
#include "responses.hpp"
#include "sequence.hpp"
#include "signals.hpp"
#include "three.hpp"
#include "two.hpp"
#include "until_100.hpp"
#include "until_10000.hpp"

namespace bench {

/// Spec NAME, over one, two or three signals, whose only monitor is m.
#define BENCH_GENERATED(NAME, ...)                                   \
    using Monitor = NAME::Monitor;                                   \
    template <class Inputs = NAME::Inputs>                           \
    static Inputs inputs(const Signals& signals, std::size_t i) {    \
        return {__VA_ARGS__};                                        \
    }                                                                \
    static constexpr std::size_t kMonitors = 1;                      \
    template <class Verdicts, class Visit>                           \
    static void visit(const Verdicts& verdicts, const Visit& take) { \
        take(0, verdicts.m);                                         \
    }
#define BENCH_P signals.p[i]
#define BENCH_PQ signals.p[i], signals.q[i]
#define BENCH_PQR signals.p[i], signals.q[i], signals.r[i]

struct NoRescanning {};

/// No operator with state: the cost of the samples, the predicates and the verdict alone.
struct One {
    static constexpr const char* kTitle = "p, sliding";
    static constexpr uint32_t kWindow = 1;
    BENCH_GENERATED(one, BENCH_P)
    struct Plain {
        void reset() {}
        void step(const Signals& s, std::size_t i, float* rho) { *rho = s.p[i]; }
    };
    using Rescanning = NoRescanning;
};

struct Two {
    static constexpr const char* kTitle = "p && q, sliding";
    static constexpr uint32_t kWindow = 1;
    BENCH_GENERATED(two, BENCH_PQ)
    struct Plain {
        void reset() {}
        void step(const Signals& s, std::size_t i, float* rho) { *rho = smaller(s.p[i], s.q[i]); }
    };
    using Rescanning = NoRescanning;
};

struct Three {
    static constexpr const char* kTitle = "p && q && r, sliding";
    static constexpr uint32_t kWindow = 1;
    BENCH_GENERATED(three, BENCH_PQR)
    struct Plain {
        void reset() {}
        void step(const Signals& s, std::size_t i, float* rho) {
            *rho = smaller(smaller(s.p[i], s.q[i]), s.r[i]);
        }
    };
    using Rescanning = NoRescanning;
};

struct Invariant {
    static constexpr const char* kTitle = "G p";
    static constexpr uint32_t kWindow = 1;
    BENCH_GENERATED(invariant, BENCH_P)
    struct Plain {
        float worst;
        void reset() { worst = kInfinity; }
        void step(const Signals& s, std::size_t i, float* rho) {
            *rho = worst = smaller(worst, s.p[i]);
        }
    };
    using Rescanning = NoRescanning;
};

/// Three over the past, whose state by hand is a ring; a bool is often true, as p is.
struct Count50 {
    static constexpr const char* kTitle = "count(b, 50 steps) < 5, sliding";
    static constexpr uint32_t kWindow = 50;
    BENCH_GENERATED(count_50, signals.p[i] > 0)
    struct Plain {
        bool begins[50];
        bool before;
        uint32_t at, count;
        void reset() { *this = {}, before = true; }
        void step(const Signals& s, std::size_t i, float* rho) {
            const bool now = s.p[i] > 0;
            count += (now && !before) - begins[at];
            begins[at] = now && !before;
            before = now;
            at = at == 49 ? 0 : at + 1;
            *rho = count < 5 ? kInfinity : -kInfinity;
        }
    };
    using Rescanning = NoRescanning;
};

struct Mean50 {
    static constexpr const char* kTitle = "mean(p, 50 steps) <= 1, sliding";
    static constexpr uint32_t kWindow = 50;
    BENCH_GENERATED(mean_50, BENCH_P)
    struct Plain {
        float last[50];
        double sum;
        uint32_t at, steps;
        void reset() { *this = {}; }
        void step(const Signals& s, std::size_t i, float* rho) {
            sum += static_cast<double>(s.p[i]) - static_cast<double>(last[at]);
            last[at] = s.p[i];
            at = at == 49 ? 0 : at + 1;
            if (steps < 50) ++steps;
            *rho = steps < 50 ? -kInfinity : 1 - static_cast<float>(sum / 50);
        }
    };
    using Rescanning = NoRescanning;
};

struct Change10 {
    static constexpr const char* kTitle = "p - p@10 <= 1, sliding";
    static constexpr uint32_t kWindow = 11;
    BENCH_GENERATED(change_10, BENCH_P)
    struct Plain {
        PlainDelay<10> last;
        uint32_t steps;
        void reset() {
            last.reset(0);
            steps = 0;
        }
        void step(const Signals& s, std::size_t i, float* rho) {
            const float before = last.push(s.p[i]);
            *rho = steps < 10 ? -kInfinity : 1 - (s.p[i] - before);
            if (steps < 10) ++steps;
        }
    };
    using Rescanning = NoRescanning;
};

struct Sequence {
    static constexpr const char* kTitle = "F (p && F (q && F r))";
    static constexpr uint32_t kWindow = 1;
    BENCH_GENERATED(sequence, BENCH_PQR)
    struct Plain {
        float first, second, third;
        void reset() { first = second = third = -kInfinity; }
        void step(const Signals& s, std::size_t i, float* rho) {
            first = larger(first, s.p[i]);
            second = larger(second, smaller(first, s.q[i]));
            *rho = third = larger(third, smaller(second, s.r[i]));
        }
    };
    using Rescanning = NoRescanning;
};

/// A window about every position.
template <template <class, uint32_t> class Window, class Monoid, uint32_t N>
struct Sliding {
    Window<Monoid, N> window;
    void reset() { window.reset(); }
    void step(const Signals& s, std::size_t i, float* rho) { *rho = window.push(s.p[i]); }
};

template <template <class, uint32_t> class Window, uint32_t N>
struct SlidingUntil {
    Window<PlainUntil, N> window;
    void reset() { window.reset(); }
    void step(const Signals& s, std::size_t i, float* rho) {
        *rho = window.push({s.q[i], s.p[i]}).value;
    }
};

struct Eventually50 {
    static constexpr const char* kTitle = "F[0,50] p, sliding";
    static constexpr uint32_t kWindow = 50;
    BENCH_GENERATED(eventually_50, BENCH_P)
    using Plain = Sliding<PlainWindow, PlainMax, 51>;
    using Rescanning = Sliding<Rescan, PlainMax, 51>;
};

struct Always1000 {
    static constexpr const char* kTitle = "G[0,1000] p, sliding";
    static constexpr uint32_t kWindow = 1000;
    BENCH_GENERATED(always_1000, BENCH_P)
    using Plain = Sliding<PlainWindow, PlainMin, 1001>;
    using Rescanning = Sliding<Rescan, PlainMin, 1001>;
};

struct Eventually100000 {
    static constexpr const char* kTitle = "F[0,100000] p, sliding";
    static constexpr uint32_t kWindow = 100000;
    BENCH_GENERATED(eventually_100000, BENCH_P)
    using Plain = Sliding<PlainWindow, PlainMax, 100001>;
    using Rescanning = NoRescanning;
};

struct Until100 {
    static constexpr const char* kTitle = "p U[0,100] q, sliding";
    static constexpr uint32_t kWindow = 100;
    BENCH_GENERATED(until_100, BENCH_PQ)
    using Plain = SlidingUntil<PlainWindow, 101>;
    using Rescanning = SlidingUntil<Rescan, 101>;
};

struct Until10000 {
    static constexpr const char* kTitle = "p U[0,10000] q, sliding";
    static constexpr uint32_t kWindow = 10000;
    BENCH_GENERATED(until_10000, BENCH_PQ)
    using Plain = SlidingUntil<PlainWindow, 10001>;
    using Rescanning = NoRescanning;
};

/// The Outer over all positions of the window's result at each: settled if the window is past,
/// otherwise decided by the newest sample, since the future is open.
template <template <class, uint32_t> class Window, class Outer, class Inner, uint32_t N>
struct OfEveryWindow {
    Window<Inner, N + 1> window;
    float settled;
    uint32_t steps;
    void reset() {
        window.reset();
        settled = Outer::identity();
        steps = 0;
    }
    void step(const Signals& s, std::size_t i, float* rho) {
        const float seen = window.push(s.p[i]);
        if (steps >= N)
            settled = Outer::combine(settled, seen);
        else
            ++steps;
        *rho = Outer::combine(settled, s.p[i]);
    }
};

struct AlwaysEventually50 {
    static constexpr const char* kTitle = "G F[0,50] p";
    static constexpr uint32_t kWindow = 50;
    BENCH_GENERATED(always_eventually_50, BENCH_P)
    using Plain = OfEveryWindow<PlainWindow, PlainMin, PlainMax, 50>;
    using Rescanning = OfEveryWindow<Rescan, PlainMin, PlainMax, 50>;
};

struct EventuallyAlways1000 {
    static constexpr const char* kTitle = "F G[0,1000] p";
    static constexpr uint32_t kWindow = 1000;
    BENCH_GENERATED(eventually_always_1000, BENCH_P)
    using Plain = OfEveryWindow<PlainWindow, PlainMax, PlainMin, 1000>;
    using Rescanning = OfEveryWindow<Rescan, PlainMax, PlainMin, 1000>;
};

/// On a prefix p U[0,100] q holds everywhere if q is met in time everywhere, and p or q holds
/// everywhere.
struct AlwaysUntil100 {
    static constexpr const char* kTitle = "G (p U[0,100] q)";
    static constexpr uint32_t kWindow = 100;
    BENCH_GENERATED(always_until_100, BENCH_PQ)
    template <template <class, uint32_t> class Window>
    struct ByHand {
        Window<PlainMax, 101> window;
        float settled, held;
        uint32_t steps;
        void reset() {
            window.reset();
            settled = held = kInfinity;
            steps = 0;
        }
        void step(const Signals& s, std::size_t i, float* rho) {
            const float seen = window.push(s.q[i]);
            if (steps >= 100)
                settled = smaller(settled, seen);
            else
                ++steps;
            held = smaller(held, larger(s.p[i], s.q[i]));
            *rho = smaller(smaller(settled, s.q[i]), held);
        }
    };
    using Plain = ByHand<PlainWindow>;
    using Rescanning = ByHand<Rescan>;
};

/// G[0,Outer] (p -> F[0,W] q) on the prefix: settled requests, and pending ones, which one q
/// answers all at once.
template <template <class, uint32_t> class Window, uint32_t W, uint32_t Outer>
struct Responding {
    Window<PlainMax, W + 1> answers;
    PlainDelay<W> excuses;
    float settled, pending;
    uint32_t steps;
    void reset() {
        answers.reset();
        excuses.reset(kInfinity);
        settled = pending = kInfinity;
        steps = 0;
    }
    void step(const Signals& s, std::size_t i, float* rho) {
        const float excuse = -s.p[i];
        const float value = larger(answers.push(s.q[i]), excuses.push(excuse));
        if (steps >= W && (Outer == kForever || steps <= Outer + W))
            settled = smaller(settled, value);
        if (Outer == kForever || steps <= Outer) pending = smaller(pending, excuse);
        pending = larger(pending, s.q[i]);
        if (Outer != kForever || steps < W) ++steps;
        *rho = smaller(settled, pending);
    }
    static constexpr uint32_t kForever = 0xffffffff;
};

struct Response50 {
    static constexpr const char* kTitle = "G (p -> F[0,50] q)";
    static constexpr uint32_t kWindow = 50;
    BENCH_GENERATED(response_50, BENCH_PQ)
    using Plain = Responding<PlainWindow, 50, 0xffffffff>;
    using Rescanning = Responding<Rescan, 50, 0xffffffff>;
};

struct NestedBounds {
    static constexpr const char* kTitle = "G[0,1000] (p -> F[0,100] q)";
    static constexpr uint32_t kWindow = 1100;
    BENCH_GENERATED(nested_bounds, BENCH_PQ)
    using Plain = Responding<PlainWindow, 100, 1000>;
    using Rescanning = Responding<Rescan, 100, 1000>;
};

struct Nested {
    static constexpr const char* kTitle = "G[0,1000] (p -> F[0,100] q), sliding";
    static constexpr uint32_t kWindow = 1100;
    BENCH_GENERATED(nested, BENCH_PQ)
    template <template <class, uint32_t> class Window>
    struct ByHand {
        Window<PlainMax, 101> answers;
        PlainDelay<100> excuses;
        Window<PlainMin, 1001> all;
        void reset() {
            answers.reset();
            excuses.reset(kInfinity);
            all.reset();
        }
        void step(const Signals& s, std::size_t i, float* rho) {
            *rho = all.push(larger(answers.push(s.q[i]), excuses.push(-s.p[i])));
        }
    };
    using Plain = ByHand<PlainWindow>;
    using Rescanning = ByHand<Rescan>;
};

/// Ten windows over one signal: each is the larger of the previous one and of its value ten steps
/// ago.
struct Responses {
    static constexpr const char* kTitle = "ten of G (p -> F[0,w] q)";
    static constexpr uint32_t kWindow = 100;
    using Monitor = responses::Monitor;
    template <class Inputs = responses::Inputs>
    static Inputs inputs(const Signals& signals, std::size_t i) {
        return {BENCH_PQ};
    }
    static constexpr std::size_t kMonitors = 10;
    template <class Verdicts, class Visit>
    static void visit(const Verdicts& verdicts, const Visit& take) {
        const etlmon::Verdict* const all[] = {
            &verdicts.m10, &verdicts.m20, &verdicts.m30, &verdicts.m40, &verdicts.m50,
            &verdicts.m60, &verdicts.m70, &verdicts.m80, &verdicts.m90, &verdicts.m100};
        for (std::size_t m = 0; m < kMonitors; ++m) take(m, *all[m]);
    }
    struct Plain {
        PlainWindow<PlainMax, 11> window;
        PlainDelay<10> answers[9], excuses[10];
        float settled[10], pending;
        uint32_t steps;
        void reset() {
            window.reset();
            for (auto& delay : answers) delay.reset(-kInfinity);
            for (auto& delay : excuses) delay.reset(kInfinity);
            for (float& value : settled) value = kInfinity;
            pending = kInfinity;
            steps = 0;
        }
        void step(const Signals& s, std::size_t i, float* rho) {
            float excuse = -s.p[i];
            float answer = window.push(s.q[i]);
            pending = larger(smaller(pending, excuse), s.q[i]);
            for (uint32_t m = 0; m < 10; ++m) {
                excuse = excuses[m].push(excuse);
                if (m > 0) answer = larger(answer, answers[m - 1].push(answer));
                if (steps >= 10 * (m + 1)) settled[m] = smaller(settled[m], larger(answer, excuse));
                rho[m] = smaller(settled[m], pending);
            }
            if (steps < 100) ++steps;
        }
    };
    template <template <class, uint32_t> class Window, class>
    struct EachOnItsOwn;
    template <template <class, uint32_t> class Window, std::size_t... M>
    struct EachOnItsOwn<Window, std::index_sequence<M...>> {
        std::tuple<Responding<Window, 10 * (M + 1), 0xffffffff>...> all;
        void reset() { (std::get<M>(all).reset(), ...); }
        void step(const Signals& s, std::size_t i, float* rho) {
            (std::get<M>(all).step(s, i, rho + M), ...);
        }
    };
    using Rescanning = EachOnItsOwn<Rescan, std::make_index_sequence<kMonitors>>;
};

/// A general state machine: no hand-written loop is known to be cheaper than the definition over
/// the horizon.
struct SmallMachine {
    static constexpr const char* kTitle = "G (p -> F[0,4] (q && X r))";
    static constexpr uint32_t kWindow = 5;
    BENCH_GENERATED(machine_small, BENCH_PQR)
    using Plain = NoRescanning;
    using Rescanning = NoRescanning;
};

struct LargeMachine {
    static constexpr const char* kTitle = "G (p U[2,20] (q && F[0,30] r))";
    static constexpr uint32_t kWindow = 50;
    BENCH_GENERATED(machine, BENCH_PQR)
    using Plain = NoRescanning;
    using Rescanning = NoRescanning;
};

#undef BENCH_GENERATED
#undef BENCH_P
#undef BENCH_PQ
#undef BENCH_PQR

}  // namespace bench
