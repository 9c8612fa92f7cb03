#include "prove/prove.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "prove/program.hpp"
#include "prove/repetition.hpp"

namespace etlc::prove {
namespace {

using etlprove::kAlways;
using etlprove::kNever;

/// Compares the verdicts of one class with their definition, in the order in which its program
/// gives them.
class Comparison {
public:
    /// `done`: counts the steps whose verdicts were compared.
    Comparison(const plan::Plan& plan, const std::set<float>& numbers,
               const std::vector<Truths>& truths, Proof& proof, data::Child& child,
               std::uint32_t& done)
        : plan_(plan),
          proof_(proof),
          truths_(truths),
          space_(numbers, !truths.empty()),
          scope_(space_),
          answers_(child, space_, plan.monitors.size()),
          known_(plan, proof.atoms, truths, proof.places, false),
          all_(plan, proof.atoms, truths, proof.places, true),
          repetition_(plan, all_, proof, space_),
          done_(done) {}

    /// Throws Ended, Exhausted and NewNumber.
    void run() {
        using etlprove::Entry;
        while (!proof_.fault) {
            switch (answers_.next()) {
                case Entry::verdict: compare(answers_.verdict()); break;
                case Entry::state: end_step(answers_.state()); break;
                case Entry::saturation: end_first_episode(answers_.word() == 1); break;
                case Entry::restarts: proof_.together = answers_.word(); break;
                case Entry::window: take(answers_.window()); break;
                case Entry::end: return end();
                default: throw Ended{0, "contradicts itself"};
            }
        }
    }

private:
    /// The tightest bounds that a monitor has given so far, of those that the definition lacks.
    struct Bounds {
        Diagram lower = kNever;
        Diagram upper = kAlways;
    };
    /// When a monitor was said to be final, though not by the definition.
    struct Promise {
        Diagram satisfied = kNever;
        Diagram violated = kNever;
    };
    /// Key of the bounds of a monitor that began at a step: `may_be_missing`, monitor, step.
    using Key = std::tuple<bool, std::uint32_t, std::uint32_t>;

    /// A verdict, and what it is about.
    struct Place {
        const Reported& reported;
        bool sliding;
        std::uint32_t position;
        bool decided;
        Key key;
    };

    Place place(const Reported& reported) const {
        const plan::Monitor& monitor = plan_.monitors[reported.monitor];
        const std::uint32_t begun = reported.begun[reported.monitor];
        Place place{reported,
                    monitor.sliding,
                    begun,
                    true,
                    {reported.may_be_missing, reported.monitor, begun}};
        if (!monitor.sliding) return place;
        // "`finish()` reports the last h positions, cut at the end of the trace, one per call"
        const std::uint32_t h = monitor.horizon;
        place.decided = reported.step + reported.finishes >= h && reported.finishes <= h;
        place.position = place.decided ? reported.step + reported.finishes - h : 0;
        return place;
    }

    void compare(const Reported& reported) {
        ++proof_.verdicts;
        const Place at = place(reported);
        begin_run(reported);
        Definition& definition = reported.may_be_missing ? all_ : known_;
        begin_step(reported);
        Numbers expected;
        if (at.decided) expected = definition.verdict(reported.monitor, reported.step, at.position);
        if (is_first_episode_ && reported.may_be_missing && at.decided) check_machine(at, expected);
        if (reported.numbers.decided != at.decided)
            return blame(at, "whether it is decided", Witness());
        if (!at.decided) return;
        truths_.empty() ? compare_numbers(at, expected) : compare_truths(at, expected);
    }

    /// Forgets what was promised before, where the class goes on from an earlier step: with other
    /// restarts. What a verdict promises binds the later ones of its own run.
    void begin_run(const Reported& reported) {
        if (reported.step < last_step_) {
            bounds_.clear();
            promises_.clear();
        }
        last_step_ = reported.step;
    }

    // ---- steps of the first episode in which samples may be missing

    void begin_step(const Reported& reported) {
        if (!is_first_episode_ || !reported.may_be_missing || reported.step < begun_steps_) return;
        ++begun_steps_;
        repetition_.begin_step();
    }

    void check_machine(const Place& at, const Numbers& expected) {
        if (!at.sliding && at.position > 0)
            return repetition_.give_up("a monitor restarts at every step");
        repetition_.check(at.reported.monitor, at.position, expected);
    }

    void end_step(const State& state) {
        std::vector<Diagram> compared_later;
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) {
            const Bounds& bounds = bounds_[{true, m, 0}];
            const Promise& promise = promises_[{true, m, 0}];
            compared_later.insert(compared_later.end(), {bounds.lower, bounds.upper,
                                                         promise.satisfied, promise.violated});
        }
        repetition_.end_step(state, compared_later);
        ++done_;
    }

    void end_first_episode(bool saturates) {
        is_first_episode_ = false;
        if (!saturates) repetition_.give_up("what it counts does not stay at the greatest number");
        proof_.repeats = saturates ? repetition_.found() : std::nullopt;
        if (proof_.repeats) return;
        proof_.why_not_longer = repetition_.why_not();
        proof_.steps_needed = repetition_.steps_needed();
    }

    void end() {
        if (proof_.long_windows.empty()) return;
        proof_.repeats.reset();
        proof_.why_not_longer = "what is assumed of its windows was compared in these steps only";
    }

    // ---- robustness

    void compare_numbers(const Place& at, const Numbers& expected) {
        const Numbers& found = at.reported.numbers;
        check(at, "robustness", found.low, expected.low);
        // Only its sign is seen, in the status.
        check(at, "the greatest possible robustness", found.high, expected.high, true);
        if (at.sliding) {
            check(at, "lower", found.lower, expected.lower);
            check(at, "upper", found.upper, expected.upper);
        } else if (at.reported.finishes == 0) {
            check_bounds(at, found, expected);
            last_[at.key] = found;
        } else {  // "a prefix monitor repeats its last verdict"
            check(at, "lower", found.lower, last_[at.key].lower);
            check(at, "upper", found.upper, last_[at.key].upper);
        }
        check_status(at, found);
    }

    /// Bounds may be tighter than the definition's, if no later verdict leaves them.
    void check_bounds(const Place& at, const Numbers& found, const Numbers& expected) {
        check(at, "lower", both(found.lower, expected.lower), expected.lower);
        check(at, "upper", both(found.upper, expected.upper), found.upper);
        Bounds& promised = bounds_[at.key];
        check(at, "the robustness, which an earlier lower bound exceeds,",
              both(promised.lower, found.low), promised.lower);
        check(at, "the robustness, which exceeds an earlier upper bound,",
              both(promised.upper, found.high), found.high);
        if (found.lower != expected.lower) promised.lower = either(promised.lower, found.lower);
        if (found.upper != expected.upper) promised.upper = both(promised.upper, found.upper);
    }

    /// "final where lower >= 0 or upper < 0"; that of a repeating monitor also "once all that the
    /// formula looks ahead has been seen"
    Diagram final_by(const Place& at, Diagram lower_holds, Diagram upper_fails) {
        const std::uint32_t ahead = plan_.monitors[at.reported.monitor].ahead;
        const bool complete =
            at.sliding || (ahead != plan::kUnbounded && at.reported.step >= at.position + ahead);
        return complete ? kAlways : either(lower_holds, upper_fails);
    }

    /// "satisfied where rho >= 0, violated where rho_high < 0"
    void check_status(const Place& at, const Numbers& found) {
        const auto sign = [&](Diagram of) { return space_.diagrams.at_zero(of); };
        const Diagram final = final_by(at, sign(found.lower), no(sign(found.upper)));
        if (at.reported.satisfied != sign(found.low) ||
            at.reported.violated != no(sign(found.high)) || at.reported.final != final)
            blame(at, "its status", Witness());
    }

    void check(const Place& at, const std::string& name, Diagram found, Diagram expected,
               bool at_zero = false) {
        if (proof_.fault || found == expected) return;
        const Reported& reported = at.reported;
        const auto witness = difference(space_, found, expected, proof_.atoms, reported.step + 1,
                                        proof_.places, reported.may_be_missing, at_zero);
        if (witness) return blame(at, name, *witness);
        if (reported.may_be_missing && is_first_episode_)
            repetition_.is_inexact(!at_zero &&
                                   are_equal_in_ranges(space_, found, expected, proof_.atoms));
    }

    // ---- truth values

    void compare_truths(const Place& at, const Numbers& expected) {
        const Reported& reported = at.reported;
        check_truth(at, "satisfied", reported.satisfied, expected.low);
        check_truth(at, "violated", reported.violated, no(expected.high));
        const Diagram due = final_by(at, expected.lower, no(expected.upper));
        check_truth(at, "final", both(reported.final, due), due);
        // It may be final earlier, if no later verdict contradicts it.
        const Diagram early = both(reported.final, no(due));
        check_truth(at, "both final and unknown",
                    both(early, no(either(reported.satisfied, reported.violated))), kNever);
        Promise& promise = promises_[at.key];
        promise.satisfied = either(promise.satisfied, both(early, reported.satisfied));
        promise.violated = either(promise.violated, both(early, reported.violated));
        check_truth(at, "final, and later no longer satisfied",
                    both(promise.satisfied, no(expected.low)), kNever);
        check_truth(at, "final, and later no longer violated",
                    both(promise.violated, expected.high), kNever);
    }

    void check_truth(const Place& at, const std::string& name, Diagram found, Diagram expected) {
        if (proof_.fault || found == expected) return;
        const Diagram differ = space_.diagrams.differ(found, expected);
        Witness witness = truths_where(space_.diagrams, differ, proof_.atoms, truths_,
                                       at.reported.step + 1, proof_.places);
        witness.first_reaches = both(differ, expected) == kNever;
        blame(at, name, std::move(witness));
    }

    void take(const Window& window) {
        if (!window.is_two_windows && !window.is_too_long)
            throw Ended{0, fmt::format("mixes up its windows of {} steps where samples are missing",
                                       window.length)};
        (window.is_too_long ? proof_.long_windows : proof_.windows).push_back(window.length);
    }

    void blame(const Place& at, const std::string& number, Witness witness) {
        if (proof_.fault) return;
        const Reported& reported = at.reported;
        proof_.fault = Fault{reported.monitor, reported.step,      at.position, reported.finishes,
                             number,           std::move(witness), {}};
        for (std::uint32_t m = 0; m < reported.begun.size(); ++m)
            if (reported.begun[m] > 0) proof_.fault->restarts.emplace_back(m, reported.begun[m]);
    }

    Diagram both(Diagram a, Diagram b) { return space_.diagrams.both(a, b); }
    Diagram either(Diagram a, Diagram b) { return space_.diagrams.either(a, b); }
    Diagram no(Diagram a) { return space_.diagrams.complement(a); }

    const plan::Plan& plan_;
    Proof& proof_;
    const std::vector<Truths>& truths_;
    Space space_;
    Symbol::Scope scope_;
    Answers answers_;
    Definition known_;
    Definition all_;
    Repetition repetition_;
    std::map<Key, Bounds> bounds_;
    std::map<Key, Promise> promises_;
    std::map<Key, Numbers> last_;  ///< verdict of each prefix monitor
    bool is_first_episode_ = true;
    std::uint32_t begun_steps_ = 0;
    std::uint32_t last_step_ = 0;  ///< of a verdict
    std::uint32_t& done_;
};

diag::Failure no_proof(std::string why) {
    return {diag::Code::no_proof, std::move(why)};
}

/// Returns "; it is right for all inputs of up to 4 steps", or nothing.
std::string how_far(std::uint32_t steps) {
    return steps == 0 ? ""
                      : fmt::format("; it is right for all inputs of up to {}",
                                    diag::counted(steps, "step"));
}

/// Adds a number and its negation.
void add(std::set<float>& numbers, double number) {
    const auto rounded = static_cast<float>(number);
    if (!std::isfinite(rounded)) return;
    numbers.insert(rounded == 0 ? 0.0F : rounded);
    numbers.insert(rounded == 0 ? 0.0F : -rounded);
}

std::set<float> numbers_of(const std::vector<Atom>& atoms) {
    std::set<float> numbers{0.0F};
    for (const Atom& atom : atoms)
        for (const double number :
             {atom.range.lowest, atom.range.highest, atom.missing.lowest, atom.missing.highest})
            add(numbers, number);
    return numbers;
}

/// Makes the proof with these numbers. Throws NewNumber.
diag::Result<Proof> prove_with(const std::set<float>& numbers, const std::vector<Truths>& truths,
                               const plan::Plan& plan, const Program& program, Proof proof) {
    proof.places = proof.steps + proof.finishes;
    const auto child = program.start(numbers, proof.steps);
    if (!child) return no_proof("cannot run the program that was compiled for the proof");
    std::uint32_t done = 0;
    try {
        Comparison(plan, numbers, truths, proof, *child, done).run();
        child->exit_status();  // it has written its coverage, if it counts
        return proof;
    } catch (const Exhausted&) {
        return no_proof("the diagrams of the definition are too large" + how_far(done));
    } catch (const Ended& ended) {
        return no_proof(why(ended) + how_far(done));
    }
}

/// Makes the proof, and adds to the numbers what it needs.
diag::Result<Proof> prove_steps(std::set<float>& numbers, const std::vector<Truths>& truths,
                                const plan::Plan& plan, const Program& program,
                                const Proof& proof) {
    constexpr std::size_t kMostNumbers = 10000;
    while (numbers.size() < kMostNumbers) {
        try {
            return prove_with(numbers, truths, plan, program, proof);
        } catch (const NewNumber& unknown) {
            add(numbers, unknown.number);
        }
    }
    return no_proof("the class has too many numbers");
}

/// The most steps of a proof that goes on until the class repeats.
constexpr std::uint32_t kMostStepsToGoOn = 256;

/// Makes the proof for the steps of the request; else for as many as all lengths need, if it can.
diag::Result<Proof> prove_all(const Request& request, const std::vector<Truths>& truths,
                              const plan::Plan& plan, const Program& program, Proof proof) {
    std::set<float> numbers = numbers_of(proof.atoms);
    auto found = prove_steps(numbers, truths, plan, program, proof);
    if (!found || found->fault || found->repeats || request.steps > 0) return found;
    if (found->steps_needed <= proof.steps || found->steps_needed > kMostStepsToGoOn) return found;
    proof.steps = found->steps_needed;
    auto longer = prove_steps(numbers, truths, plan, program, proof);
    if (longer && (longer->fault || longer->repeats)) return longer;
    if (longer) found->why_not_longer = longer->why_not_longer;
    return found;
}

}  // namespace

std::uint32_t usual_steps(const plan::Plan& plan) {
    std::uint32_t horizon = 0;
    std::uint32_t buffer = 0;
    for (const plan::Monitor& monitor : plan.monitors) horizon = std::max(horizon, monitor.horizon);
    for (const plan::Stream& stream : plan.streams) buffer = std::max(buffer, stream.length);
    return std::max(64U, 2 * horizon + buffer);
}

std::uint32_t finishes_of(const plan::Plan& plan) {
    constexpr std::uint32_t kMore = 8;  // after the last that reports something
    std::uint32_t calls = 0;
    for (const plan::Monitor& monitor : plan.monitors) calls = std::max(calls, monitor.horizon);
    return plan.has_sliding ? calls + kMore : 0;
}

float measured(const check::Predicate& predicate, float robustness) {
    const float epsilon = predicate.threshold.value;
    if (predicate.equality()) {
        const bool is_equal =
            (robustness > 0) == (predicate.comparison == check::Comparison::equal);
        return is_equal ? epsilon : epsilon + 1;
    }
    return predicate.upper_bound() ? epsilon - robustness : epsilon + robustness;
}

diag::Result<Proof> prove(const plan::Plan& plan, const Request& request) {
    Proof proof;
    proof.atoms = atoms_of(plan);
    proof.steps = request.steps > 0 ? request.steps : usual_steps(plan);
    proof.finishes = finishes_of(plan);
    const std::vector<Truths> truths = truths_of(plan, proof.atoms);
    const auto program = Program::make(plan, request, proof.atoms, truths);
    if (!program) return program.failure();
    proof.compiler = program->compiler();
    auto found = prove_all(request, truths, plan, *program, std::move(proof));
    if (found && request.counts_lines) found->coverage = program->coverage();
    return found;
}

}  // namespace etlc::prove
