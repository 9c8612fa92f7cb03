// One formula of cases.hpp as routines to time and compare.
// Takes: a case and signals. Gives: the routines, and the state of the monitor. Keeps true: all
// routines of a row use the same samples, write their results to memory, and were seen to agree on
// every robustness.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "copilot/copilot.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "explained.hpp"
#include "timing.hpp"

namespace bench {

constexpr std::size_t kSteps = 1 << 15;
constexpr std::size_t kChunk =
    512;  ///< results are overwritten, so that they stay in the first-level cache

/// The steps in a loop, which keeps the state in registers if possible; or called one by one, as in
/// a control loop, with the state in memory between calls.
template <class T>
struct Ways {
    T loop, call;
};

struct Row {
    std::string title;
    std::size_t state_bytes = 0;
    std::uint32_t operations = 0;
    Ways<std::optional<Routine>> plain;  ///< robustness by hand
    /// The same, going through every window at each step, in a loop.
    std::optional<Routine> rescan;
    std::optional<Routine> copilot;  ///< Copilot's monitor, called
    /// The monitor on given predicates; its user reads only `robustness`.
    Ways<Routine> judge;
    /// The same; its user reads the whole verdict, as for `alarm()`.
    Ways<Routine> judged;
    /// The latter for a class made with --explain.
    Ways<std::optional<Routine>> why;
    Ways<std::optional<Routine>> why_step;  ///< its whole step, with the whole verdict
    std::size_t why_state_bytes = 0;
    Ways<Routine> rho;              ///< the monitor's whole step
    Ways<Routine> verdict;          ///< the same; its user reads the whole verdict
    std::function<double()> worst;  ///< nanoseconds of its slowest step
};

/// The monitor's predicates at each step.
template <class Case, class Monitor, class Inputs>
std::vector<typename Monitor::Atoms> measured(const Signals& signals) {
    const auto monitor = std::make_unique<Monitor>();
    std::vector<typename Monitor::Atoms> atoms;
    for (std::size_t i = 0; i < signals.size(); ++i)
        atoms.push_back(monitor->measure(Case::template inputs<Inputs>(signals, i)));
    return atoms;
}

/// A chunk of steps with given predicates, robustness only.
template <class Case, bool kCalled, class Monitor>
[[gnu::noinline]] void judge_robustness(Monitor& monitor,
                                        const std::vector<typename Monitor::Atoms>& atoms,
                                        std::size_t from, float* __restrict out) {
    for (std::size_t i = 0; i < kChunk; ++i) {
        Case::visit(monitor.judge(atoms[from + i]),
                    [&](std::size_t m, const etlmon::Verdict& verdict) {
                        out[i * Case::kMonitors + m] = verdict.robustness;
                    });
        if (kCalled) settle_memory();
    }
}

/// The same, with every whole verdict.
template <class Case, bool kCalled, class Monitor>
[[gnu::noinline]] void judge_verdict(Monitor& monitor,
                                     const std::vector<typename Monitor::Atoms>& atoms,
                                     std::size_t from, etlmon::Verdict* __restrict out) {
    for (std::size_t i = 0; i < kChunk; ++i) {
        Case::visit(monitor.judge(atoms[from + i]),
                    [&](std::size_t m, const etlmon::Verdict& verdict) {
                        out[i * Case::kMonitors + m] = verdict;
                    });
        if (kCalled) settle_memory();
    }
}

/// The monitor's user: a chunk of steps, robustness only.
template <class Case, bool kCalled>
[[gnu::noinline]] void read_robustness(typename Case::Monitor& monitor, const Signals& signals,
                                       std::size_t from, float* __restrict out) {
    for (std::size_t i = 0; i < kChunk; ++i) {
        Case::visit(monitor.step(Case::inputs(signals, from + i)),
                    [&](std::size_t m, const etlmon::Verdict& verdict) {
                        out[i * Case::kMonitors + m] = verdict.robustness;
                    });
        if (kCalled) settle_memory();
    }
}

/// A chunk of steps, with every whole verdict.
template <class Case, bool kCalled, class Monitor, class Inputs>
[[gnu::noinline]] void read_verdict(Monitor& monitor, const Signals& signals, std::size_t from,
                                    etlmon::Verdict* __restrict out) {
    for (std::size_t i = 0; i < kChunk; ++i) {
        Case::visit(monitor.step(Case::template inputs<Inputs>(signals, from + i)),
                    [&](std::size_t m, const etlmon::Verdict& verdict) {
                        out[i * Case::kMonitors + m] = verdict;
                    });
        if (kCalled) settle_memory();
    }
}

template <class ByHand, std::size_t kMonitors, bool kCalled>
[[gnu::noinline]] void by_hand(ByHand& monitor, const Signals& signals, std::size_t from,
                               float* __restrict out) {
    for (std::size_t i = 0; i < kChunk; ++i) {
        monitor.step(signals, from + i, out + i * kMonitors);
        if (kCalled) settle_memory();
    }
}

[[gnu::noinline]] inline void by_copilot(CopilotStep step, const Signals& signals, std::size_t from,
                                         float* __restrict out) {
    for (std::size_t i = 0; i < kChunk; ++i) out[i] = step(signals, from + i);
}

/// Goes over all steps of a trace, chunk by chunk, calling a function per chunk.
template <class Result, class State, class Trace, class Chunk>
Routine routine(const std::string& name, std::size_t monitors,
                const std::shared_ptr<const Trace>& trace, const Chunk& chunk) {
    const auto state = std::make_shared<State>();
    const auto results = std::make_shared<std::vector<Result>>(kChunk * monitors);
    state->reset();
    return {name,
            [=] {
                for (std::size_t from = 0; from < kSteps; from += kChunk) {
                    chunk(*state, *trace, from, results->data());
                    settle_memory();
                }
            },
            kSteps};
}

/// Exits if the two compared routines differ.
template <class Case, class ByHand>
void check(const Signals& signals, ByHand& by_hand) {
    const auto monitor = std::make_unique<typename Case::Monitor>();
    monitor->reset();
    by_hand.reset();
    float rho[Case::kMonitors];
    for (std::size_t i = 0; i < signals.size(); ++i) {
        by_hand.step(signals, i, rho);
        Case::visit(monitor->step(Case::inputs(signals, i)),
                    [&](std::size_t m, const etlmon::Verdict& verdict) {
                        if (verdict.decided() && verdict.robustness != rho[m])
                            throw std::logic_error(std::string(Case::kTitle) +
                                                   ": what it is compared with disagrees at step " +
                                                   std::to_string(i));
                    });
    }
}

/// Returns Copilot's monitor of the formula, if any; exits if it computes something else.
template <class Case>
std::optional<Routine> copilot_routine(const std::shared_ptr<const Signals>& signals) {
    const auto step = copilot_step(Case::kTitle);
    if (!step) return std::nullopt;
    struct Stepped {
        CopilotStep one;
        void reset() {}
        void step(const Signals& of, std::size_t i, float* rho) { *rho = one(of, i); }
    };
    Stepped stepped{*step};
    check<Case>(*signals, stepped);
    const auto results = std::make_shared<std::vector<float>>(kChunk);
    return Routine{"copilot",
                   [=] {
                       for (std::size_t from = 0; from < kSteps; from += kChunk) {
                           by_copilot(*step, *signals, from, results->data());
                           settle_memory();
                       }
                   },
                   kSteps};
}

template <class Case>
double slowest_step() {
    const Signals signals = saws(std::max<std::size_t>(Case::kWindow, 1024));
    const auto monitor = std::make_unique<typename Case::Monitor>();
    auto inputs = Case::inputs(signals, 0);
    std::vector<etlmon::Verdict> verdicts(Case::kMonitors);
    const auto keep = [&](std::size_t m, const etlmon::Verdict& verdict) { verdicts[m] = verdict; };
    return worst_step(signals.size(), {[&] { monitor->reset(); },
                                       [&](std::size_t i) { inputs = Case::inputs(signals, i); },
                                       [&] { Case::visit(monitor->step(inputs), keep); }});
}

/// judge() alone, on given predicates: for its robustness, and for whole verdicts.
template <class Case, class Monitor, class Inputs>
struct Judging {
    Ways<Routine> robustness, verdict;

    explicit Judging(const std::string& name, const Signals& signals)
        : Judging(name, std::make_shared<const Atoms>(measured<Case, Monitor, Inputs>(signals))) {}

private:
    using Atoms = std::vector<typename Monitor::Atoms>;
    Judging(const std::string& name, const std::shared_ptr<const Atoms>& atoms)
        : robustness{routine<float, Monitor>(name, Case::kMonitors, atoms,
                                             judge_robustness<Case, false, Monitor>),
                     routine<float, Monitor>(name + ", called", Case::kMonitors, atoms,
                                             judge_robustness<Case, true, Monitor>)},
          verdict{routine<etlmon::Verdict, Monitor>(name + ", verdict", Case::kMonitors, atoms,
                                                    judge_verdict<Case, false, Monitor>),
                  routine<etlmon::Verdict, Monitor>(name + ", verdict, called", Case::kMonitors,
                                                    atoms, judge_verdict<Case, true, Monitor>)} {}
};

template <class Case>
Row row() {
    using Monitor = typename Case::Monitor;
    constexpr std::size_t kMonitors = Case::kMonitors;
    const auto signals = std::make_shared<const Signals>(walks(kSteps));
    Row result;
    result.title = Case::kTitle;
    result.state_bytes = Monitor::kStateBytes;
    result.operations = Monitor::kOperations;
    if constexpr (!std::is_same_v<typename Case::Plain, NoRescanning>) {
        using Plain = typename Case::Plain;
        check<Case>(*signals, *std::make_unique<Plain>());
        result.plain = {
            routine<float, Plain>("plain", kMonitors, signals, by_hand<Plain, kMonitors, false>),
            routine<float, Plain>("plain, called", kMonitors, signals,
                                  by_hand<Plain, kMonitors, true>)};
    }
    if constexpr (!std::is_same_v<typename Case::Rescanning, NoRescanning>) {
        using Rescanning = typename Case::Rescanning;
        check<Case>(*signals, *std::make_unique<Rescanning>());
        result.rescan = routine<float, Rescanning>("rescan", kMonitors, signals,
                                                   by_hand<Rescanning, kMonitors, false>);
    }
    result.copilot = copilot_routine<Case>(signals);
    const auto monitored = [&](auto result_type, const char* name, auto chunk) {
        return routine<decltype(result_type), Monitor>(name, kMonitors, signals, chunk);
    };
    using Inputs = decltype(Case::inputs(*signals, 0));
    const Judging<Case, Monitor, Inputs> judging("ready", *signals);
    result.judge = judging.robustness;
    result.judged = judging.verdict;
    if constexpr (Explained<Monitor>::kExists) {
        using Why = Explained<Monitor>;
        const Judging<Case, typename Why::Monitor, typename Why::Inputs> why("why", *signals);
        result.why = {why.verdict.loop, why.verdict.call};
        result.why_step = {
            routine<etlmon::Verdict, typename Why::Monitor>(
                "why, step", kMonitors, signals,
                read_verdict<Case, false, typename Why::Monitor, typename Why::Inputs>),
            routine<etlmon::Verdict, typename Why::Monitor>(
                "why, step, called", kMonitors, signals,
                read_verdict<Case, true, typename Why::Monitor, typename Why::Inputs>)};
        result.why_state_bytes = Why::Monitor::kStateBytes;
    }
    result.rho = {monitored(float{}, "robustness", read_robustness<Case, false>),
                  monitored(float{}, "robustness, called", read_robustness<Case, true>)};
    result.verdict = {
        monitored(etlmon::Verdict{}, "verdict", read_verdict<Case, false, Monitor, Inputs>),
        monitored(etlmon::Verdict{}, "verdict, called", read_verdict<Case, true, Monitor, Inputs>)};
    result.worst = slowest_step<Case>;
    return result;
}

}  // namespace bench
