// Proves that monitors which restart do not disturb each other. Takes: the states of a class, and
// how to restart a monitor of it and to step it. Gives: whether each monitor, restarted at any
// step, gives the same verdicts whenever the others restart. Keeps true: the proof is by induction
// over steps. A state is made of the words that a monitor's restarts change, and of those that none
// changes; from each such state one step is taken in which the diagrams of the other monitors are
// unknown.
#pragma once

#include <string.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "etlmon/temporal/verdict.hpp"

namespace etlprove {

/// The bytes of a class.
template <class Monitor>
struct Memory {
    alignas(Monitor) unsigned char bytes[sizeof(Monitor)];
    Monitor& operator*() { return *reinterpret_cast<Monitor*>(bytes); }
};
template <class Monitor>
using State = std::unique_ptr<Memory<Monitor>>;

template <class Monitor>
constexpr uint32_t kWords = sizeof(Monitor) / sizeof(uint32_t);

/// A word that held a diagram and was not written since.
constexpr uint32_t kNeverSet = 0x5b5b5b5b;

template <class Monitor>
State<Monitor> copy_of(const State<Monitor>& state) {
    return std::make_unique<Memory<Monitor>>(*state);
}
template <class Monitor>
uint32_t word(const Memory<Monitor>& of, size_t at) {
    uint32_t word = 0;
    memcpy(&word, of.bytes + at * sizeof word, sizeof word);
    return word;
}
template <class Monitor>
void set(Memory<Monitor>& of, size_t at, uint32_t word) {
    memcpy(of.bytes + at * sizeof word, &word, sizeof word);
}

/// [step]: words that depend on earlier restarts, and on which no verdict does.
using LeftOver = std::vector<std::set<uint32_t>>;

template <class Monitor, class Verdicts>
class Together {
public:
    struct Class {
        uint32_t monitors;
        const std::vector<uint32_t>& restartable;
        void (*restart)(Monitor&, uint32_t monitor);
        const std::vector<State<Monitor>>& states;  ///< before each step, without restarts
        const std::vector<LeftOver>& left_over;     ///< of each that is restartable
    };
    using Advance = std::function<Verdicts(Memory<Monitor>&, uint32_t step)>;

    Together(Class about, Advance advance)
        : about_(about), advance_(std::move(advance)), count_(about.restartable.size()) {
        constexpr uint64_t kMostSteps = 60000;  // of the class, in about two seconds
        const uint64_t most = about.states.size() - 1;
        while (count_ > 1 && steps_ < most &&
               count_ * (steps_ + 1) * (steps_ + 1) * (steps_ + 1) < 3 * kMostSteps)
            ++steps_;
    }

    /// Returns how many steps it covers: 0 if fewer than two monitors restart.
    uint32_t steps() const { return static_cast<uint32_t>(steps_); }

    /// Returns whether the proof succeeds.
    bool run() {
        if (steps_ == 0) return true;
        owner_.assign(kWords<Monitor>, kNobody);
        for (uint32_t step = 0; step < steps_; ++step) {
            Memory<Monitor> state = *about_.states[step];
            plain_.verdicts.push_back(advance_(state, step));
        }
        for (uint32_t n = 0; n < count_; ++n)
            if (!record(n)) return false;
        for (uint32_t step = 1; step < steps_; ++step)
            for (uint32_t others = 1; others <= step; ++others) {
                for (uint32_t n = 0; n < count_; ++n) {
                    if (!restarts_alone(n, others, step)) return false;
                    for (uint32_t at = 0; at <= step; ++at)
                        if (!steps_alone(n, at, others, step)) return false;
                }
                if (!steps_alone(kNobody, 0, others, step)) return false;
            }
        return true;
    }

private:
    static constexpr uint32_t kNobody = 0xffffffffu;

    /// The states before each step of a class in which one monitor was restarted, and its verdicts.
    struct Run {
        std::vector<Memory<Monitor>> states;
        std::vector<Verdicts> verdicts;
    };

    Class about_;
    Advance advance_;
    size_t count_;
    uint64_t steps_ = 0;
    Run plain_;                           ///< without restarts; its states are those of the class
    std::vector<uint32_t> owner_;         ///< [word]: the monitor whose restarts change it
    std::vector<std::vector<Run>> runs_;  ///< [monitor][step of the restart, from 1]

    /// Runs the class with restarts of one monitor. Returns whether no word is that of two.
    bool record(uint32_t n) {
        runs_.emplace_back(steps_);
        for (uint32_t at = 1; at < steps_; ++at) {
            Memory<Monitor> state = *about_.states[at];
            about_.restart(*state, about_.restartable[n]);
            for (const uint32_t left : about_.left_over[n][at]) set(state, left, kNeverSet);
            Run& run = runs_[n][at];
            for (uint32_t step = at; step < steps_; ++step) {
                run.states.push_back(state);
                if (!own(n, state, *about_.states[step])) return false;
                run.verdicts.push_back(advance_(state, step));
            }
            run.states.push_back(state);
            if (!own(n, state, *about_.states[steps_])) return false;
        }
        return true;
    }

    bool own(uint32_t n, const Memory<Monitor>& restarted, const Memory<Monitor>& plain) {
        for (uint32_t w = 0; w < kWords<Monitor>; ++w) {
            if (word(restarted, w) == word(plain, w)) continue;
            if (owner_[w] != kNobody && owner_[w] != n) return false;
            owner_[w] = n;
        }
        return true;
    }

    /// Returns the state before a step, where one monitor was restarted before step `at`, if that
    /// is not 0.
    const Memory<Monitor>& state_of(uint32_t n, uint32_t at, uint32_t step) const {
        return at == 0 ? *about_.states[step] : runs_[n][at].states[step - at];
    }

    /// Returns the state before a step, where the other monitors were restarted before step
    /// `others` and what their diagrams say is unknown.
    Memory<Monitor> state_with(uint32_t n, uint32_t at, uint32_t others, uint32_t step) const {
        Memory<Monitor> state = state_of(n, at, step);
        for (uint32_t w = 0; w < kWords<Monitor>; ++w) {
            if (owner_[w] == kNobody || owner_[w] == n) continue;
            const uint32_t of = word(state_of(owner_[w], others, step), w);
            set(state, w, is_marked(of) ? kNeverSet : of);
        }
        return state;
    }

    /// Whether a step changes the words of a monitor and the words of none as it does alone, and
    /// gives the same verdict.
    bool steps_alone(uint32_t n, uint32_t at, uint32_t others, uint32_t step) {
        Memory<Monitor> state = state_with(n, at, others, step);
        const Verdicts verdicts = advance_(state, step);
        const Memory<Monitor>& alone = state_of(n, at, step + 1);
        for (uint32_t w = 0; w < kWords<Monitor>; ++w)
            if ((owner_[w] == kNobody || owner_[w] == n) && word(state, w) != word(alone, w))
                return false;
        const Verdicts& expected =
            at == 0 ? plain_.verdicts[step] : runs_[n][at].verdicts[step - at];
        if (n != kNobody) return same(verdicts, expected, about_.restartable[n]);
        for (uint32_t m = 0; m < about_.monitors; ++m)
            if (!restarts(m) && !same(verdicts, expected, m)) return false;
        return true;
    }

    bool restarts(uint32_t monitor) const {
        const std::vector<uint32_t>& all = about_.restartable;
        return std::find(all.begin(), all.end(), monitor) != all.end();
    }

    static bool same(const Verdicts& a, const Verdicts& b, uint32_t monitor) {
        constexpr size_t kBytes = sizeof(etlmon::Verdict);
        const auto* const one = reinterpret_cast<const unsigned char*>(&a) + monitor * kBytes;
        return memcmp(one, reinterpret_cast<const unsigned char*>(&b) + monitor * kBytes, kBytes) ==
               0;
    }

    /// Whether a restart before the step changes the monitor's own words, and to the same.
    bool restarts_alone(uint32_t n, uint32_t others, uint32_t step) {
        Memory<Monitor> state = state_with(n, 0, others, step);
        const Memory<Monitor> before = state;
        about_.restart(*state, about_.restartable[n]);
        for (uint32_t w = 0; w < kWords<Monitor>; ++w) {
            const bool is_own = owner_[w] == n;
            const uint32_t expected = word(is_own ? runs_[n][step].states[0] : before, w);
            const bool is_left_over = is_own && expected == kNeverSet;
            if (!is_left_over && word(state, w) != expected) return false;
        }
        return true;
    }
};

}  // namespace etlprove
