// Steps a class of truth values, for `etlc prove`, through every case: every state that it can be
// in, and every sequence of choices from there. Takes: a class, and for each monitor the part of
// the state that its verdict depends on. Gives: on standard output, per step and monitor, the
// conditions of each answer as diagrams over all samples. Keeps true: states with the same part are
// one, and the condition of a state is that of all ways to it; past a number of cases it ends.
#pragma once

#include <string.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlprove/choices.hpp"
#include "etlprove/finish.hpp"
#include "etlprove/output.hpp"

namespace etlprove {

/// More nodes of diagrams take too long.
constexpr uint32_t kMostNodesOfCases = 16u << 20;
/// States whose step is not taken again.
constexpr size_t kMostKept = 10000;

/// Bytes of the state of a class.
struct Part {
    size_t first, bytes;
};

template <class Monitor, class Member>
Part part(const Monitor& monitor, const Member& member) {
    const auto first =
        reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&monitor);
    return {static_cast<size_t>(first), sizeof member};
}

/// A monitor, and what its verdict depends on.
struct Target {
    uint32_t monitor;
    bool is_prefix;
    bool repeats;  ///< it also restarts after a final verdict
    bool freezes;  ///< a final verdict stays, whatever else it depended on
    std::vector<Part> parts;
    std::vector<bool> atoms;
    std::vector<uint32_t> restarts;  ///< monitors whose restart changes these parts
};

template <class Monitor>
struct CasesOf {
    uint32_t steps;
    uint32_t finishes;    ///< calls of finish() that report something
    uint64_t most_cases;  ///< of all steps together
    void (*restart)(Monitor&, uint32_t monitor);
    std::vector<Target> targets;
};

template <class Monitor, class Verdicts>
class Cases {
public:
    Cases(CasesOf<Monitor> about) : about_(std::move(about)) {}

    void run() {
        for (const Target& target : about_.targets) {
            const Memory first = reset(target, 0);
            if (target.freezes && part(target, first) != part(target, reset(target, 0xff)))
                stop(kLeftovers);
            runs_.push_back(begin(target, first));
        }
        for (uint32_t step = 0; step < about_.steps; ++step)
            for (Run& run : runs_) advance(run, step);
        for (Run& run : runs_) run_later(run);
        put(static_cast<uint32_t>(Entry::end));
        stop(0);
    }

private:
    struct Memory {
        alignas(Monitor) unsigned char bytes[sizeof(Monitor)];
        Monitor& operator*() { return *reinterpret_cast<Monitor*>(bytes); }
    };
    /// Conditions by the step at which a monitor last began.
    using Begun = std::map<uint32_t, Diagram>;
    struct State {
        Memory memory{};
        uint8_t status = 0;  ///< of the last verdict
        Diagram condition = kNever;
        Begun begun;
    };
    using States = std::map<std::string, State>;
    /// Where a step leads to, and when, by the choices of a step.
    struct Outcome {
        Memory memory;
        uint8_t status;
        bool restarted;
        uint32_t step;
        Diagram when = kNever;
    };
    using Outcomes = std::map<std::pair<std::string, bool>, Outcome>;
    struct Answer {
        Diagram begun = kNever, satisfied = kNever, violated = kNever, decided = kNever,
                final = kNever;
    };
    struct Run {
        const Target* target;
        States states;
        Memory first;                           ///< in which an episode begins
        std::map<std::string, Memory> later{};  ///< what reset() made of later states, if not that
        std::map<std::string, Outcomes> outcomes{};  ///< of states that had a step
    };

    CasesOf<Monitor> about_;
    std::vector<Run> runs_;
    uint64_t cases_ = 0;
    Sent sent_;

    static std::string part(const Target& target, const Memory& memory) {
        std::string bytes;
        for (const Part& part : target.parts)
            bytes.append(reinterpret_cast<const char*>(memory.bytes) + part.first, part.bytes);
        return bytes;
    }

    /// Returns the state that reset() makes of one in which the parts have these bytes.
    static Memory reset(const Target& target, int byte) {
        Memory memory{};
        (*memory).reset();
        for (const Part& part : target.parts) memset(memory.bytes + part.first, byte, part.bytes);
        (*memory).reset();
        return memory;
    }

    static Run begin(const Target& target, const Memory& first) {
        return {&target, {{part(target, first), {first, 0, kAlways, {{0, kAlways}}}}}, first};
    }

    /// Episodes after a reset() that leaves something of an earlier one.
    void run_later(Run& run) {
        for (auto at = run.later.begin(); at != run.later.end(); ++at) {
            put(static_cast<uint32_t>(Entry::reset));
            put(1);
            Run again = begin(*run.target, at->second);
            for (uint32_t step = 0; step < about_.steps; ++step) advance(again, step);
            const size_t before = run.later.size();
            run.later.merge(again.later);
            if (run.later.size() != before) at = run.later.begin();
        }
        put(static_cast<uint32_t>(Entry::reset));
        put(0);
    }

    void advance(Run& run, uint32_t step) {
        if (diagrams().size() > kMostNodesOfCases) stop(kExhausted);
        run.states = stepped(run, run.states, step, false);
        States ended = run.states;
        for (uint32_t call = 0; call < about_.finishes; ++call)
            ended = stepped(run, ended, step + 1 + call, true);
        fflush(stdout);
    }

    /// Takes every case of a step, or of a call of finish(), and reports the verdicts.
    States stepped(Run& run, const States& from, uint32_t step, bool finishing) {
        States next;
        std::map<uint32_t, Answer> answers;
        for (const auto& [key, state] : from) {
            const bool is_usual = !finishing && step > 0;
            const auto known = is_usual ? run.outcomes.find(key) : run.outcomes.end();
            const Outcomes found = known != run.outcomes.end()
                                       ? known->second
                                       : outcomes(*run.target, state.memory, step, finishing);
            for (const auto& [way, outcome] : found)
                add({*run.target, state, outcome, step, finishing}, answers, next[way.first]);
            if (is_usual && run.outcomes.size() < kMostKept) run.outcomes.emplace(key, found);
        }
        for (auto& [key, state] : next)
            if (!run.target->freezes) check_reset(run, state.memory);
        report(answers);
        return next;
    }

    /// Steps from one state with every sequence of choices.
    Outcomes outcomes(const Target& target, const Memory& from, uint32_t step, bool finishing) {
        Outcomes found;
        choices().begin(step, target.atoms, finishing);
        do {
            if (++cases_ > about_.most_cases) stop(kTooMany);
            Memory memory = from;
            const bool restarted = !finishing && step > 0 && restart(target, *memory);
            const Verdicts verdicts =
                finishing ? finish<Monitor, Verdicts>(*memory, 0) : (*memory).step({});
            uint8_t status = 0;
            memcpy(&status, reinterpret_cast<const char*>(&verdicts) + target.monitor, 1);
            const bool frozen = target.freezes && (status & etlmon::BooleanVerdict::kFinal) != 0;
            std::string key = frozen ? "" : part(target, memory);
            key += static_cast<char>(status);
            Outcome& outcome = found
                                   .emplace(std::make_pair(key, restarted),
                                            Outcome{memory, status, restarted, step})
                                   .first->second;
            outcome.when = diagrams().either(outcome.when, choices().condition());
        } while (choices().next());
        return found;
    }

    bool restart(const Target& target, Monitor& monitor) {
        bool itself = false;
        for (const uint32_t other : target.restarts) {
            if (!choices().is_restarted(other)) continue;
            about_.restart(monitor, other);
            itself = itself || other == target.monitor;
        }
        return itself;
    }

    struct Case {
        const Target& target;
        const State& from;
        const Outcome& to;
        uint32_t step;
        bool finishing;
    };

    void add(const Case& now, std::map<uint32_t, Answer>& answers, State& state) {
        using Bits = etlmon::BooleanVerdict;
        Diagrams& all = diagrams();
        const uint8_t status = now.to.status;
        const bool ends = (status & Bits::kFinal) != 0 && now.target.repeats && !now.finishing;
        const bool repeats_last = now.finishing && now.target.is_prefix;
        state.memory = now.to.memory;
        state.status = status;
        const Diagram when = choices().moved(now.to.when, now.to.step, now.step);
        const Begun begun =
            now.to.restarted ? Begun{{now.step, now.from.condition}} : now.from.begun;
        for (const auto& [at, within] : begun) {
            const Diagram here = all.both(when, within);
            if (here == kNever) continue;
            Answer& answer = answers[repeats_last ? 0 : at];
            const auto count = [&](Diagram& of, bool yes) {
                if (yes) of = all.either(of, here);
            };
            const auto is = [&](uint8_t bit) { return !repeats_last && (status & bit) != 0; };
            count(answer.begun, true);
            count(answer.satisfied,
                  repeats_last ? status != now.from.status : is(Bits::kSatisfied));
            count(answer.violated, is(Bits::kViolated));
            count(answer.decided, is(Bits::kDecided));
            count(answer.final, is(Bits::kFinal));
            count(state.condition, true);
            count(state.begun[ends ? now.step + 1 : at], true);
        }
    }

    /// A reset() has to make the state in which the first episode began, or one more is tried.
    void check_reset(Run& run, const Memory& memory) {
        Memory again = memory;
        (*again).reset();
        const std::string key = part(*run.target, again);
        if (key != part(*run.target, run.first)) run.later.emplace(key, again);
    }

    void report(const std::map<uint32_t, Answer>& answers) {
        for (const auto& [begun, answer] : answers) {
            const Diagram conditions[] = {answer.begun, answer.satisfied, answer.violated,
                                          answer.decided, answer.final};
            for (const Diagram condition : conditions) sent_.send(condition);
            put(static_cast<uint32_t>(Entry::status));
            put(begun);
            for (const Diagram condition : conditions) put(condition);
        }
        put(static_cast<uint32_t>(Entry::finished));
    }
};

}  // namespace etlprove
