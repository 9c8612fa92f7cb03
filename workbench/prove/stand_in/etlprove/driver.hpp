// Steps a class on symbols, for `etlc prove`, whose program includes the header and this file.
// Takes: the number of steps, and what the program knows of the class. Gives: on standard output,
// for each verdict the diagrams of its numbers, and every diagram once, before its first use.
// Keeps true: the class is used through its public functions only; it begins in reset(), in the
// first episode and in a later one, so that a member that reset() leaves out is noticed.
#pragma once

#include <string.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "etlprove/finish.hpp"
#include "etlprove/output.hpp"
#include "etlprove/together.hpp"
#include "etlprove/windows.hpp"

namespace etlprove {

// ---- output -------------------------------------------------------------------------------------

/// The kinds of words of a state.
enum class WordKind : uint32_t { control, diagram, counter };

/// Ends the program: it needs another number.
[[noreturn]] inline void ask_for(float number) {
    uint32_t bits = 0;
    memcpy(&bits, &number, sizeof bits);
    put(static_cast<uint32_t>(Entry::number));
    put(bits);
    stop(kNewNumber);
}

/// Reads the numbers of the proof: their bits, in order.
inline void take_numbers(int count, char** words) {
    std::vector<float> taken;
    for (int n = 0; n < count; ++n) {
        const uint32_t bits = static_cast<uint32_t>(strtoul(words[n], nullptr, 16));
        float number = 0;
        memcpy(&number, &bits, sizeof number);
        taken.push_back(number);
    }
    Numbers& kept = numbers();  // which begins without numbers
    kept = Numbers(diagrams(), taken);
}

// ---- the class ----------------------------------------------------------------------------------

/// A class, as the program knows it.
template <class Monitor>
struct Class {
    uint32_t atoms;      ///< that the class reads
    uint32_t all_atoms;  ///< with those that only the definition reads
    uint32_t monitors;
    std::vector<uint32_t> restartable;  ///< monitors that restart
    std::vector<uint32_t> repeating;    ///< those that also restart after a final verdict
    void (*restart)(Monitor&, uint32_t monitor);
    uint32_t finishes;  ///< calls of finish() that report something
    std::vector<WindowOfClass> windows;
};

template <class Monitor, class Verdicts>
class Driver {
public:
    Driver(Class<Monitor> about, uint32_t steps) : about_(std::move(about)), steps_(steps) {}

    void run() {
        State known = first_episode();
        State state = later_episode();
        for (uint32_t step = 0; step < steps_; ++step) {
            states_.push_back(copy_of<Monitor>(state));
            report(advance(*known, step, false));
            uses().reset();
            report(advance(*state, step, true));
            State ended = copy_of<Monitor>(state);
            for (uint32_t call = 0; call < about_.finishes; ++call)
                report(finish<Monitor, Verdicts>(**ended, 0));
            report_state(*state);
        }
        states_.push_back(copy_of<Monitor>(state));
        for (const uint32_t monitor : about_.restartable) {
            left_over_.assign(steps_, {});
            for (uint32_t step = 1; step < steps_; ++step) run_restarted(monitor, step);
            left_over_by_monitor_.push_back(left_over_);
        }
        for (uint32_t n = 0; n < about_.repeating.size(); ++n)
            for (uint32_t step = 1; step < steps_; ++step) run_repeated(n, step);
        report_together();
        for (const WindowOfClass& window : about_.windows) {
            put(static_cast<uint32_t>(Entry::window));
            put(window.length);
            put(window.is_two_windows == nullptr ? 2 : window.is_two_windows() ? 1 : 0);
            fflush(stdout);
        }
        put(static_cast<uint32_t>(Entry::end));
        stop(0);
    }

private:
    using State = etlprove::State<Monitor>;
    using Atoms = typename Monitor::Atoms;
    using Value = typename Monitor::Value;

    Class<Monitor> about_;
    uint32_t steps_;
    std::vector<State> states_;  ///< before each step, with every sample possibly missing
    LeftOver left_over_;         ///< of the monitor that restarts
    std::vector<LeftOver> left_over_by_monitor_;  ///< of each that can restart
    std::set<uint32_t> counters_;                 ///< words that count final verdicts
    Sent sent_;

    static State first_episode() {
        State state = std::make_unique<Memory<Monitor>>();
        memset(state->bytes, 0, sizeof state->bytes);
        (**state).reset();
        return state;
    }

    /// Returns a state that reset() has made of a used one, whose values no verdict may depend on.
    State later_episode() {
        State state = first_episode();
        for (uint32_t step = 0; step < steps_ / 2 + 1; ++step) advance(*state, step, true);
        for (size_t at = 0; at < kWords<Monitor>; ++at)
            if (is_marked(word(*state, at))) set(*state, at, kNeverSet);
        (**state).reset();
        return state;
    }

    etlmon::Value sample(uint32_t step, uint32_t atom, bool may_be_missing) const {
        const auto end = [&](Place place) {
            return etlmon::Key::of(
                diagrams().variable(place_of({step, steps_}, atom, about_.all_atoms, place)));
        };
        return {end(kLow), end(may_be_missing ? kHigh : kLow)};
    }

    Verdicts advance(Memory<Monitor>& state, uint32_t step, bool may_be_missing) {
        std::vector<Value> values;
        for (uint32_t atom = 0; atom < about_.atoms; ++atom)
            values.push_back(Value(sample(step, atom, may_be_missing)));
        Atoms now{};
        static_assert(sizeof(Value) % sizeof(uint32_t) == 0, "no padding");
        memcpy(static_cast<void*>(&now), values.data(), values.size() * sizeof(Value));
        finals().asked = 0;
        return (*state).judge(now);
    }

    void report(const Verdicts& verdicts) {
        for (uint32_t m = 0; m < about_.monitors; ++m) {
            etlmon::Verdict verdict;
            memcpy(static_cast<void*>(&verdict),
                   reinterpret_cast<const unsigned char*>(&verdicts) + m * sizeof verdict,
                   sizeof verdict);
            const bool decided = is_marked(verdict.status.high);
            const Diagram numbers[] = {verdict.robustness.key.diagram(),
                                       diagram_of(verdict.status.high), verdict.lower.key.diagram(),
                                       verdict.upper.key.diagram()};
            for (const Diagram number : numbers)
                if (decided) sent_.send(number);
            put(static_cast<uint32_t>(Entry::verdict));
            put(decided ? 1 : 0);
            for (const Diagram number : numbers) put(number);
        }
        fflush(stdout);
    }

    /// Reports the words of a state, and how the step used those before.
    void report_state(const Memory<Monitor>& state) {
        std::vector<WordKind> kinds(kWords<Monitor>, WordKind::control);
        for (size_t at = 0; at < kWords<Monitor>; ++at) {
            const uint32_t bits = word(state, at);
            if (!is_marked(bits) || diagram_of(bits) >= diagrams().size()) continue;
            sent_.send(diagram_of(bits));
            kinds[at] = WordKind::diagram;
        }
        for (const void* const counter : uses().counters())
            for (size_t at = 0; at < kWords<Monitor>; ++at)
                if (counter == state.bytes + at * sizeof(uint32_t)) kinds[at] = WordKind::counter;
        const bool is_whole = kWords<Monitor> * sizeof(uint32_t) == sizeof(Monitor);
        put(static_cast<uint32_t>(Entry::state));
        put(is_whole ? kWords<Monitor> : 0);
        for (size_t at = 0; is_whole && at < kWords<Monitor>; ++at) {
            const uint32_t bits = word(state, at);
            put(static_cast<uint32_t>(kinds[at]));
            put(kinds[at] == WordKind::diagram ? diagram_of(bits) : bits);
        }
        put(uses().counted());
        put(uses().oldest());
        fflush(stdout);
    }

    /// The monitor is restarted before the step. Words of the state that depend on earlier restarts
    /// are unwritten here, so that the verdicts prove that they do not count.
    void run_restarted(uint32_t monitor, uint32_t at) {
        State state = copy_of<Monitor>(states_[at]);
        about_.restart(**state, monitor);
        for (const uint32_t word : left_over_[at]) set(*state, word, kNeverSet);
        run_from(std::move(state), monitor, at);
    }

    /// The monitor restarts by itself after the step before.
    void run_repeated(uint32_t n, uint32_t at) {
        State state = copy_of<Monitor>(states_[at - 1]);
        finals().chosen = uint64_t{1} << n;
        advance(*state, at - 1, true);
        finals().chosen = 0;
        State asked = copy_of<Monitor>(states_[at]);
        about_.restart(**asked, about_.repeating[n]);
        for (size_t at_word = 0; at_word < kWords<Monitor>; ++at_word)
            if (!is_marked(word(*state, at_word)) && word(*state, at_word) != word(*asked, at_word))
                counters_.insert(static_cast<uint32_t>(at_word));
        run_from(std::move(state), about_.repeating[n], at);
    }

    void run_from(State state, uint32_t monitor, uint32_t at) {
        bool forgotten = true;
        for (uint32_t step = at; step < steps_; ++step) {
            if (step > at) forgotten = forgets(*state, monitor, step) && forgotten;
            report(advance(*state, step, true));
        }
        put(static_cast<uint32_t>(Entry::reset));
        put(forgotten ? 1 : 0);
    }

    void report_together() {
        Together<Monitor, Verdicts> together(
            {about_.monitors, about_.restartable, about_.restart, states_, left_over_by_monitor_},
            [this](Memory<Monitor>& state, uint32_t step) { return advance(state, step, true); });
        put(static_cast<uint32_t>(Entry::together));
        put(together.steps());
        put(together.run() ? 1 : 0);
        fflush(stdout);
    }

    /// Whether a restart before the step gives the state that it gives without the earlier one, but
    /// for diagrams that are left over.
    bool forgets(const Memory<Monitor>& restarted, uint32_t monitor, uint32_t step) {
        Memory<Monitor> again = restarted;
        State first = copy_of<Monitor>(states_[step]);
        about_.restart(*again, monitor);
        about_.restart(**first, monitor);
        for (size_t at = 0; at < kWords<Monitor>; ++at) {
            const uint32_t one = word(again, at), other = word(*first, at);
            if (one == other || counters_.count(static_cast<uint32_t>(at)) != 0) continue;
            const bool are_diagrams =
                (one == kNeverSet || is_marked(one)) && (other == kNeverSet || is_marked(other));
            if (!are_diagrams) return false;
            left_over_[step].insert(static_cast<uint32_t>(at));
        }
        return true;
    }
};

}  // namespace etlprove
