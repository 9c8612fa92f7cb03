// The calls of a class on symbols, for `etlc prove`. Takes: a state, and a call. Gives: what the
// call answers and the states that it leads to. Keeps true: every way through the call is taken;
// a way on which monitors restart after their final verdicts leads to what the same restarts lead
// to if they are asked for.
#pragma once

#include <string.h>

#include <utility>
#include <vector>

#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/demand.hpp"
#include "etlmon/temporal/predicate.hpp"
#include "etlmon/views.hpp"
#include "etlprove/diagrams.hpp"
#include "etlprove/space.hpp"

namespace etlprove {

/// An atom that the class reads.
struct AtomOfClass {
    uint32_t index;  ///< among all atoms
    Truths truths;
    bool vanishes;  ///< it is missing where its inputs are: finish() has none
    bool missing;   ///< what it counts as then, if it is declared
};

/// The values of atoms at a step.
class Samples {
public:
    /// `order`: in which a step asks for atoms; `atoms`: all of them; `of`: steps that have places.
    void describe(std::vector<AtomOfClass> order, uint32_t atoms, uint32_t of) {
        order_ = std::move(order);
        atoms_ = atoms;
        of_ = of;
    }
    void begin(uint32_t step, bool may_be_missing, bool finishing) {
        step_ = step;
        may_be_missing_ = may_be_missing;
        finishing_ = finishing;
        begin_again();
    }
    void begin_again() { turn_ = 0; }

    etlmon::Value value(uint32_t atom) const {
        const auto end = [&](Place place) {
            return etlmon::Key::of(diagrams().variable(first(atom) + place));
        };
        return {end(kLow), end(may_be_missing_ ? kHigh : kLow)};
    }
    etlmon::Value next_value() { return value(next().index); }
    etlmon::Truth next_truth() {
        const AtomOfClass& atom = next();
        if (!finishing_ || !atom.vanishes) {
            const Ends ends = ends_of(diagrams(), atom.truths, first(atom.index));
            return {Bit::of(ends.low), Bit::of(ends.high)};
        }
        return atom.truths == Truths::any   ? etlmon::kPerhaps
               : atom.truths == Truths::yes ? etlmon::kYes
               : atom.truths == Truths::no  ? etlmon::kNo
                                            : etlmon::truth_of(Bit(atom.missing));
    }

private:
    Place first(uint32_t atom) const { return place_of({step_, of_}, atom, atoms_, 0); }
    const AtomOfClass& next() {
        if (turn_ >= order_.size()) stop(kOtherHalves);
        return order_[turn_++];
    }

    std::vector<AtomOfClass> order_;
    uint32_t atoms_ = 0, of_ = 0, step_ = 0;
    bool may_be_missing_ = false, finishing_ = false;
    size_t turn_ = 0;
};

inline Samples& samples() {
    static Samples kept;
    return kept;
}
inline etlmon::Value next_value() {
    return samples().next_value();
}
inline etlmon::Truth next_truth() {
    return samples().next_truth();
}

/// A verdict, with the diagrams of its numbers.
struct Answer {
    uint32_t decided = 0;
    Diagram numbers[7] = {};  ///< low, high, lower, upper, satisfied, violated, final

    Diagram satisfied() const { return numbers[4]; }
    Diagram violated() const { return numbers[5]; }
    Diagram final() const { return numbers[6]; }
    bool operator==(const Answer& other) const { return memcmp(this, &other, sizeof *this) == 0; }
};

inline Answer answer_of(const Status& status, const etlmon::Key (&keys)[4]) {
    Answer answer;
    answer.decided = status.decided;
    if (status.decided == 0) return answer;
    for (int n = 0; n < 4; ++n) answer.numbers[n] = keys[n].diagram();
    answer.numbers[4] = status.satisfied.diagram();
    answer.numbers[5] = status.violated.diagram();
    answer.numbers[6] = status.final.diagram();
    return answer;
}
inline Answer answer_of(const etlmon::Verdict& verdict) {
    return answer_of(verdict.status, {verdict.robustness.key, verdict.high.key, verdict.lower.key,
                                      verdict.upper.key});
}
inline Answer answer_of(const etlmon::BooleanVerdict& verdict) {
    return answer_of(verdict.status,
                     {etlmon::kBottom, etlmon::kBottom, etlmon::kBottom, etlmon::kBottom});
}

/// The bytes of a class.
template <class Monitor>
struct Memory {
    alignas(Monitor) unsigned char bytes[sizeof(Monitor)];
    Monitor& operator*() { return *reinterpret_cast<Monitor*>(bytes); }
    const Monitor& operator*() const { return *reinterpret_cast<const Monitor*>(bytes); }

    static constexpr size_t kWords = sizeof(Monitor) / sizeof(uint32_t);
    uint32_t word(size_t at) const {
        uint32_t word = 0;
        memcpy(&word, bytes + at * sizeof word, sizeof word);
        return word;
    }
    void set(size_t at, uint32_t word) { memcpy(bytes + at * sizeof word, &word, sizeof word); }
};

/// Makes a sample present.
inline void give(float& input, double number) {
    input = static_cast<float>(number);
}
inline void give(etlmon::Flag& input, double) {
    input = true;
}
template <class Element, size_t Dim>
void give(etlmon::Vector<Element, Dim>& input, double) {
    static const Element zeros[Dim]{};
    input = etlmon::Vector<Element, Dim>::unchecked(zeros);
}

/// Monitors, as bits.
using Set = uint64_t;

template <class Subject>
class Calls {
public:
    using Monitor = typename Subject::Monitor;
    using Verdicts = typename Subject::Verdicts;
    using State = Memory<Monitor>;
    using Answers = std::vector<Answer>;

    /// The answers of a call, and the state after it if no more monitors restart by themselves than
    /// have to.
    struct Result {
        Answers answers;
        Set restarted = 0;
        State state;
    };

    /// A step, or the half of it that judges.
    Result step(const State& from, bool whole) {
        return call(from, true, [whole](Monitor& monitor) {
            return whole ? Subject::step(monitor) : Subject::judge(monitor);
        });
    }
    /// A step in its halves. `present`: it has samples.
    Result step_with(const State& from, bool present) {
        return call(from, true,
                    [present](Monitor& monitor) { return Subject::step_with(monitor, present); });
    }
    Result finish(const State& from) { return call(from, false, Subject::finish); }

    static const std::vector<size_t>& telemetry() {
        static const std::vector<size_t> kept = [] {
            std::vector<size_t> words;
            const State state{};
            for (const void* const member : Subject::telemetry(*state))
                words.push_back(
                    static_cast<size_t>(static_cast<const unsigned char*>(member) - state.bytes) /
                    sizeof(uint32_t));
            return words;
        }();
        return kept;
    }
    /// Sets words of telemetry to what they were: no verdict may depend on them.
    static void keep_telemetry(const State& before, State& after) {
        for (const size_t word : telemetry()) after.set(word, before.word(word));
    }

private:
    /// A way through the call.
    struct Way {
        Answers answers;
        State state;
        Diagram condition;
        std::vector<std::pair<Diagram, bool>> finals;  ///< what was asked, and answered
    };

    template <class Function>
    Result call(const State& from, bool may_restart, const Function& function) {
        uses().reset();
        std::vector<Diagram> finals;
        std::vector<Way> all;
        if (may_restart && Subject::kRepeats) {
            ways().set_free({});
            ways().each([&] { all.push_back(take(from, function)); }, true);
            finals = finals_of(all[0].answers);
            all.clear();
        }
        // That a verdict is final, by itself, decides nothing else.
        ways().set_free(finals);
        ways().each([&] { all.push_back(take(from, function)); });
        Result result;
        result.answers = merged(all);
        if (may_restart && finals_of(result.answers) != finals) stop(kBranches);
        join(from, all, may_restart, result);
        return result;
    }

    template <class Function>
    Way take(const State& from, const Function& function) {
        Way way{{}, from, kAlways, {}};
        samples().begin_again();
        uses().set_object(way.state.bytes, sizeof way.state.bytes);
        recorded().statuses = 0;
        const Verdicts verdicts = function(*way.state);
        if (recorded().is && recorded().statuses != Subject::kMonitors) stop(kReadsTelemetry);
        for (uint32_t m = 0; m < Subject::kMonitors; ++m)
            way.answers.push_back(Subject::answer(verdicts, m));
        if (!Subject::is_named(verdicts)) stop(kOtherNames);
        for (const size_t word : telemetry())
            if (uses().so_far().counted(word) > 0) stop(kReadsTelemetry);
        way.condition = ways().condition();
        way.finals = ways().finals();
        return way;
    }

    /// Returns the conditions on which repeating monitors restart, each once.
    static std::vector<Diagram> finals_of(const Answers& answers) {
        std::vector<Diagram> finals;
        for (uint32_t m = 0; m < answers.size(); ++m)
            if (Subject::repeats(m) && answers[m].final() > kAlways)
                finals.push_back(answers[m].final());
        return finals;
    }

    static Diagram choose(Diagram condition, Diagram then, Diagram otherwise) {
        Diagrams& all = diagrams();
        if (then == otherwise) return then;
        return all.either(all.both(condition, then),
                          all.both(all.complement(condition), otherwise));
    }

    /// The answers of all ways; truths may differ on them.
    static Answers merged(const std::vector<Way>& all) {
        Answers answers = all.back().answers;
        for (size_t w = all.size() - 1; w-- > 0;)
            for (uint32_t m = 0; m < answers.size(); ++m) {
                const Answer& other = all[w].answers[m];
                if (other == answers[m]) continue;
                if (!are_truths() || other.decided != answers[m].decided) stop(kBranches);
                for (int n = 0; n < 7; ++n)
                    answers[m].numbers[n] =
                        choose(all[w].condition, other.numbers[n], answers[m].numbers[n]);
            }
        return answers;
    }

    /// Returns the monitors that restart on a way, and adds those of which it does not say.
    static Set restarted_on(const Way& way, const Answers& answers, Set& unknown) {
        Set set = 0;
        for (uint32_t m = 0; m < answers.size(); ++m) {
            if (!Subject::repeats(m)) continue;
            const Set bit = Set{1} << m;
            bool is_known = answers[m].final() <= kAlways;
            if (answers[m].final() == kAlways) set |= bit;
            for (const auto& [asked, answered] : way.finals) {
                if (asked != answers[m].final()) continue;
                is_known = true;
                if (answered) set |= bit;
            }
            if (!is_known) unknown |= bit;
        }
        return set;
    }

    /// Joins the ways with the fewest restarts, and compares the others with them.
    void join(const State& from, const std::vector<Way>& all, bool may_restart, Result& result) {
        std::vector<Set> sets, unknown(all.size(), 0);
        Set fewest = ~Set{0};
        for (size_t w = 0; w < all.size(); ++w) {
            sets.push_back(may_restart ? restarted_on(all[w], result.answers, unknown[w]) : 0);
            fewest &= sets[w];
        }
        bool is_first = true;
        for (size_t w = all.size(); w-- > 0;) {
            if (sets[w] != fewest) continue;
            State state = all[w].state;
            keep_telemetry(from, state);
            if (!is_first) join(all[w].condition, state, result.state);
            if (is_first) result.state = state;
            is_first = false;
        }
        if (is_first) stop(kBranches);
        result.restarted = fewest;
        for (size_t w = 0; w < all.size(); ++w) {
            if (!counts(from, all[w], sets[w], result.answers)) stop(kOtherRestarts);
            // A monitor of whose verdict a way does not say anything restarts on it, or does not.
            for (Set more = unknown[w];; more = (more - 1) & unknown[w]) {
                if (!is_as_asked(from, all[w], sets[w] | more, result)) stop(kOtherRestarts);
                if (more == 0) break;
            }
        }
    }

    static void join(Diagram condition, const State& way, State& with) {
        for (size_t at = 0; at < State::kWords; ++at) {
            const uint32_t one = way.word(at), other = with.word(at);
            if (one == other) continue;
            if (!are_truths() || !is_marked(one) || !is_marked(other)) stop(kBranches);
            with.set(at, marked(choose(condition, one & ~kMarkBits, other & ~kMarkBits)));
        }
    }

    /// Whether the way leads to what the restarts lead to if they are asked for.
    bool is_as_asked(const State& from, const Way& way, Set restarted, const Result& result) {
        State expected = result.state;
        for (uint32_t m = 0; m < Subject::kMonitors; ++m)
            if ((restarted & ~result.restarted) >> m & 1) Subject::restart(*expected, m);
        State state = way.state;
        keep_telemetry(from, state);
        Diagrams& all = diagrams();
        for (size_t at = 0; at < State::kWords; ++at) {
            const uint32_t one = state.word(at), other = expected.word(at);
            if (one == other) continue;
            if (!is_marked(one) || !is_marked(other)) return false;
            const Diagram differ = all.differ(one & ~kMarkBits, other & ~kMarkBits);
            if (!are_truths() || all.both(way.condition, differ) != kNever) return false;
        }
        return true;
    }

    /// Whether each restarted monitor, and no other, counts an alarm where its verdict is violated,
    /// that it was fulfilled where it is satisfied, and nothing where it is unknown.
    static bool counts(const State& from, const Way& way, Set restarted, const Answers& answers) {
        for (uint32_t m = 0; m < answers.size(); ++m) {
            if (!Subject::repeats(m)) continue;
            const auto [alarms, fulfilled] = Subject::counts(*way.state, m);
            const auto [alarms_before, fulfilled_before] = Subject::counts(*from, m);
            const uint32_t more = alarms - alarms_before, others = fulfilled - fulfilled_before;
            if ((restarted >> m & 1) == 0 && (more > 0 || others > 0)) return false;
            if ((restarted >> m & 1) == 0) continue;
            Diagrams& all = diagrams();
            const Diagram when = all.both(way.condition, answers[m].final());
            const auto never = [&](Diagram of) { return all.both(when, of) == kNever; };
            const Diagram satisfied = answers[m].satisfied(), violated = answers[m].violated();
            if (more > 1 || others > 1) return false;
            if (!never(more == 1 ? all.complement(violated) : violated)) return false;
            // What its bounds make final is satisfied if it is not violated. No diagram says so,
            // nor that nothing is both.
            const bool by_bounds = answers[m].final() != kAlways;
            if (others == 1 ? !never(all.complement(satisfied)) && !(by_bounds && never(violated))
                            : !never(all.both(satisfied, all.complement(violated))))
                return false;
        }
        return true;
    }
};

}  // namespace etlprove
