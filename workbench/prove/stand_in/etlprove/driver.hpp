// Drives a class as programs do, for `etlc prove`: it is constructed in memory that holds anything,
// stepped, restarted, finished and reset, at any time and again. Takes: a Subject, which names what
// the class has. Gives: on standard output, for each verdict the diagrams of its numbers, and every
// diagram once, before its first use. Keeps true: what a call may leave in the state is in the
// state of every episode that follows, as a value that may be anything.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "etlprove/calls.hpp"
#include "etlprove/windows.hpp"

namespace etlprove {

inline void put(uint32_t word) {
    if (fwrite(&word, sizeof word, 1, stdout) != 1) _Exit(1);
}
inline void put(Entry entry) {
    put(static_cast<uint32_t>(entry));
}

/// Writes diagrams before those that contain them.
class Sent {
public:
    void send(Diagram of) {
        if (sent_.size() < diagrams().size()) sent_.resize(diagrams().size(), false);
        if (sent_[of]) return;
        const Diagrams::Node node = diagrams()[of];
        send(node.without);
        send(node.with);
        sent_[of] = true;
        put(Entry::node);
        put(of);
        put(node.place);
        put(node.without);
        put(node.with);
    }

private:
    std::vector<bool> sent_{true, true};
};

/// Ends the program: it needs another number.
[[noreturn]] inline void ask_for(float number) {
    uint32_t bits = 0;
    static_assert(sizeof bits == sizeof number, "");
    __builtin_memcpy(&bits, &number, sizeof bits);
    put(Entry::number);
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

/// How long the class is driven.
struct Lengths {
    uint32_t steps;
    uint32_t finishes;  ///< calls of finish() after each step
    uint64_t together;  ///< most ways through steps for restarts of several monitors
};

template <class Subject>
class Driver {
    using Monitor = typename Subject::Monitor;
    using State = Memory<Monitor>;
    using Result = typename Calls<Subject>::Result;
    /// The step at which each monitor last began.
    using Begun = std::vector<uint32_t>;
    static constexpr uint32_t kMonitors = Subject::kMonitors;

public:
    explicit Driver(Lengths lengths) : lengths_(lengths) {}

    void run() {
        first_ = constructed();
        if (!are_truths()) run_known();
        do {
            left_over_count_ = left_over_.size();
            run_all(false);
        } while (left_over_.size() != left_over_count_);
        run_all(true);
        report_saturation();
        if (Subject::kMeasures) run_with_samples();
        for (uint32_t m = 0; m < kMonitors; ++m)
            if (Subject::restarts(m)) {
                left_by_restart_.assign(lengths_.steps + 1, {});
                for (uint32_t step = 1; step < lengths_.steps; ++step) run_restarted(m, step);
            }
        const uint32_t together = run_together();
        put(Entry::restarts);
        put(together);
        for (const WindowOfClass& window : Subject::windows(*first_)) {
            put(Entry::window);
            put(window.length);
            put(window.is_two_windows == nullptr ? 2 : window.is_two_windows() ? 1 : 0);
            fflush(stdout);
        }
        put(Entry::end);
        stop(0);
    }

private:
    /// Words that depend on earlier calls, and that no verdict may depend on.
    using Left = std::set<size_t>;

    Lengths lengths_;
    Calls<Subject> calls_;
    State first_;  ///< as the constructor makes it
    Left left_over_;
    size_t left_over_count_ = 0;
    std::vector<State> states_;  ///< before each step
    std::vector<Begun> begun_;
    std::vector<Left> left_by_restart_;  ///< [step]: of the monitor that restarts
    Sent sent_;

    // ---- output

    void report(const Result& result, bool may_be_missing, uint32_t step, uint32_t finishes,
                const Begun& begun) {
        for (uint32_t m = 0; m < kMonitors; ++m) {
            const Answer& answer = result.answers[m];
            for (const Diagram number : answer.numbers) sent_.send(number);
            put(Entry::verdict);
            for (const uint32_t word :
                 {uint32_t{may_be_missing}, m, step, finishes, answer.decided})
                put(word);
            for (const uint32_t step_of : begun) put(step_of);
            for (const Diagram number : answer.numbers) put(number);
        }
        fflush(stdout);
    }

    /// Reports the words of a state, and how the step used those before.
    void report_state(const State& state, const Used& used) {
        std::vector<WordKind> kinds(State::kWords, WordKind::control);
        for (size_t at = 0; at < State::kWords; ++at) {
            const uint32_t bits = state.word(at);
            if (used.advanced.count(at) != 0) kinds[at] = WordKind::counter;
            if (!is_marked(bits) || diagram_of(bits) >= diagrams().size()) continue;
            sent_.send(diagram_of(bits));
            kinds[at] = WordKind::diagram;
        }
        const bool is_whole = State::kWords * sizeof(uint32_t) == sizeof(Monitor);
        put(Entry::state);
        put(is_whole ? State::kWords : 0);
        for (size_t at = 0; is_whole && at < State::kWords; ++at) {
            const uint32_t bits = state.word(at);
            put(static_cast<uint32_t>(kinds[at]));
            put(kinds[at] == WordKind::diagram ? diagram_of(bits) : bits);
            put(kinds[at] == WordKind::counter ? used.counted(at) : 0);
        }
        put(used.oldest);
        fflush(stdout);
    }

    // ---- episodes

    /// Constructs the class in memory that holds anything.
    static State constructed() {
        State one, other;
        memset(one.bytes, 0x5a, sizeof one.bytes);
        memset(other.bytes, 0x3c, sizeof other.bytes);
        Subject::construct(one.bytes);
        Subject::construct(other.bytes);
        for (size_t at = 0; at < State::kWords; ++at)
            if (one.word(at) != other.word(at)) one.set(at, left_over(at));
        return one;
    }

    State first_with_left_over() const {
        State state = first_;
        for (const size_t at : left_over_) state.set(at, left_over(at));
        return state;
    }

    /// A reset() has to make the state that the constructor makes, but for values that are left,
    /// whatever the class has counted.
    void check_reset(const State& state) {
        State again = state;
        for (const size_t at : Calls<Subject>::telemetry()) again.set(at, 1);
        do_blindly(again, [](Monitor& monitor) { monitor.reset(); });
        for (size_t at = 0; at < State::kWords; ++at) {
            if (again.word(at) == first_.word(at)) continue;
            if (!is_marked(again.word(at))) stop(kLeftovers);
            left_over_.insert(at);
        }
    }

    static void restart(State& state, uint32_t monitor) {
        do_blindly(state, [=](Monitor& of) { Subject::restart(of, monitor); });
    }

    /// Calls what must not read a word of the class.
    template <class Function>
    static void do_blindly(State& state, const Function& function) {
        uses().reset();
        uses().set_object(state.bytes, sizeof state.bytes);
        function(*state);
        if (!uses().so_far().counts.empty()) stop(kLeftovers);
    }

    static void begin_after(Set restarted, uint32_t step, Begun& begun) {
        for (uint32_t m = 0; m < kMonitors; ++m)
            if ((restarted >> m & 1) != 0) begun[m] = step + 1;
    }

    /// An episode without a missing sample, of the class as it was constructed.
    void run_known() {
        State state = first_;
        Begun begun(kMonitors, 0);
        for (uint32_t step = 0; step < lengths_.steps; ++step) {
            samples().begin(step, false, false);
            const Result result = calls_.step(state, Subject::kMeasures);
            report(result, false, step, 0, begun);
            begin_after(result.restarted, step, begun);
            state = result.state;
        }
    }

    /// A later episode, in which every sample may be missing.
    void run_all(bool reports) {
        State state = first_with_left_over();
        Begun begun(kMonitors, 0);
        states_.clear();
        begun_.clear();
        for (uint32_t step = 0; step < lengths_.steps; ++step) {
            states_.push_back(state);
            begun_.push_back(begun);
            samples().begin(step, true, false);
            if (!are_truths() && Subject::kMeasures) check_halves(state);
            const Result result = calls_.step(state, are_truths());
            Used used = uses().so_far();
            if (reports) report(result, true, step, 0, begun);
            begin_after(result.restarted, step, begun);
            state = result.state;
            run_finishes(state, step, begun_.back(), reports, used);
            if (reports) report_state(state, used);
            check_reset(state);
        }
        states_.push_back(state);
        begun_.push_back(begun);
    }

    /// An episode of steps some of which have samples. The atoms are as before, so that
    /// nothing else may depend on samples, nor on what measuring leaves in the state.
    void run_with_samples() {
        State state = first_;
        Begun begun(kMonitors, 0);
        for (uint32_t step = 0; step < lengths_.steps; ++step) {
            samples().begin(step, true, false);
            const Result result = calls_.step_with(state, step % 3 != 1);
            report(result, true, step, 0, begun);
            begin_after(result.restarted, step, begun);
            state = result.state;
        }
    }

    /// Adds to what was used.
    void run_finishes(State state, uint32_t step, const Begun& begun, bool reports, Used& used) {
        for (uint32_t call = 1; call <= lengths_.finishes; ++call) {
            samples().begin(step + call, true, true);
            const Result result = calls_.finish(state);
            for (const auto& [word, constant] : uses().so_far().counts) used.count(word, constant);
            if (reports) report(result, true, step, call, begun);
            state = result.state;
            check_reset(state);
        }
    }

    /// A step has to be its two halves, and the first one names each atom.
    void check_halves(const State& state) {
        const Result whole = calls_.step(state, true);
        const Used of_whole = uses().so_far();
        const Result half = calls_.step(state, false);
        const Used of_half = uses().so_far();
        if (whole.answers != half.answers || whole.restarted != half.restarted) stop(kOtherHalves);
        State measured = state;
        samples().begin_again();
        if (!Subject::measures(*measured)) stop(kOtherNames);
        for (size_t at = 0; at < State::kWords; ++at)
            if (measured.word(at) == state.word(at) &&
                (whole.state.word(at) != half.state.word(at) ||
                 of_whole.counted(at) > of_half.counted(at)))
                stop(kOtherHalves);
    }

    /// Whether words that count do not change what a step does once they have reached the greatest
    /// number, and stay there.
    void report_saturation() {
        bool is_right = true;
        const uint32_t last = lengths_.steps - 1;
        samples().begin(last, true, false);
        const Result usual = calls_.step(states_[last], are_truths());
        std::vector<size_t> counters;
        for (size_t at = 0; at < State::kWords; ++at)
            if (usual.state.word(at) != states_[last].word(at) &&
                uses().so_far().advanced.count(at) != 0)
                counters.push_back(at);
        for (const uint32_t less : {1u, 0u}) {
            State state = states_[last];
            for (const size_t at : counters) state.set(at, 0xffffffffu - less);
            const Result late = calls_.step(state, are_truths());
            State expected = usual.state;
            for (const size_t at : counters) expected.set(at, 0xffffffffu);
            is_right = is_right && late.answers == usual.answers &&
                       late.restarted == usual.restarted &&
                       memcmp(late.state.bytes, expected.bytes, sizeof expected.bytes) == 0;
        }
        put(Entry::saturation);
        put(is_right ? 1 : 0);
    }

    // ---- restarts

    /// The monitor is restarted before the step. Words of the state that depend on earlier restarts
    /// may be anything here, so that the verdicts prove that they do not count.
    void run_restarted(uint32_t monitor, uint32_t at) {
        State state = states_[at];
        restart(state, monitor);
        for (const size_t word : left_by_restart_[at]) state.set(word, left_over(word));
        Begun begun = begun_[at];
        begun[monitor] = at;
        for (uint32_t step = at; step < lengths_.steps; ++step) {
            if (step > at) check_restart(state, monitor, step);
            samples().begin(step, true, false);
            const Result result = calls_.step(state, are_truths());
            report(result, true, step, 0, begun);
            begin_after(result.restarted, step, begun);
            state = result.state;
            check_reset_again(state);
        }
    }

    /// A reset() after restarts must leave no more than one before.
    void check_reset_again(const State& state) {
        const size_t before = left_over_.size();
        check_reset(state);
        if (left_over_.size() != before) stop(kLeftovers);
    }

    /// A restart before the step has to give the state that it gives without the earlier one, but
    /// for diagrams that are left over.
    void check_restart(const State& restarted, uint32_t monitor, uint32_t step) {
        State again = restarted, first = states_[step];
        restart(again, monitor);
        restart(first, monitor);
        for (size_t at = 0; at < State::kWords; ++at) {
            const uint32_t one = again.word(at), other = first.word(at);
            if (one == other) continue;
            if (!is_marked(one) || !is_marked(other)) stop(kLeftovers);
            left_by_restart_[step].insert(at);
        }
    }

    /// All sequences of restarts of several monitors. Returns in how many steps they are right.
    uint32_t run_together() {
        std::vector<uint32_t> restartable;
        for (uint32_t m = 0; m < kMonitors; ++m)
            if (Subject::restarts(m)) restartable.push_back(m);
        if (restartable.size() < 2) return 0;
        std::map<Begun, State> now{{Begun(kMonitors, 0), first_with_left_over()}};
        const uint64_t before = ways().count();
        for (uint32_t step = 0; step < lengths_.steps; ++step) {
            if (step > 0 && !add_restarts(restartable, step, now)) return step;
            std::map<Begun, State> next;
            samples().begin(step, true, false);
            for (auto& [begun, state] : now) {
                if (ways().count() - before > lengths_.together) return step;
                const Result result = calls_.step(state, are_truths());
                report(result, true, step, 0, begun);
                Begun then = begun;
                begin_after(result.restarted, step, then);
                if (!add(then, result.state, next)) return step;
            }
            now = std::move(next);
        }
        return lengths_.steps;
    }

    /// Adds the states after every restart before the step.
    bool add_restarts(const std::vector<uint32_t>& restartable, uint32_t step,
                      std::map<Begun, State>& states) {
        for (const uint32_t m : restartable) {
            const std::map<Begun, State> before = states;
            for (const auto& [begun, state] : before) {
                Begun then = begun;
                then[m] = step;
                State restarted = state;
                restart(restarted, m);
                if (!add(then, restarted, states)) return false;
            }
        }
        return true;
    }

    /// Adds a state; where its values differ from those of one that is there, they may be anything.
    static bool add(const Begun& begun, const State& state, std::map<Begun, State>& states) {
        const auto [there, is_new] = states.emplace(begun, state);
        for (size_t at = 0; !is_new && at < State::kWords; ++at) {
            if (there->second.word(at) == state.word(at)) continue;
            if (!is_marked(there->second.word(at)) || !is_marked(state.word(at))) return false;
            there->second.set(at, left_over(at));
        }
        return true;
    }
};

}  // namespace etlprove
