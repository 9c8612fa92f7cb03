#include "prove/prove.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "prove/boolean.hpp"
#include "prove/program.hpp"
#include "prove/repetition.hpp"
#include "prove/text/members.hpp"

namespace etlc::prove {
namespace {

/// Compares the verdicts of one class with their definition, in the order in which its program
/// gives them.
class Comparison {
public:
    /// `done`: counts the steps whose verdicts were compared.
    Comparison(const plan::Plan& plan, const std::set<float>& numbers, Proof& proof,
               data::Child& child, std::uint32_t& done)
        : plan_(plan),
          proof_(proof),
          space_(numbers),
          scope_(space_),
          answers_(child, space_),
          known_(plan, proof.atoms, proof.steps, false),
          all_(plan, proof.atoms, proof.steps, true),
          repetition_(plan, all_, proof, space_),
          done_(done) {}

    /// Throws Ended and Exhausted.
    void run() {
        for (; done_ < proof_.steps && !proof_.fault; ++done_) {
            compare_step(done_, Kind::known);
            repetition_.begin_step();
            compare_step(done_, Kind::missing);
            compare_finishes(done_);
            if (!proof_.fault) repetition_.end_step(answers_.state(), compared_later());
            known_.forget(done_);
        }
        proof_.repeats = repetition_.found();
        if (!proof_.repeats) proof_.why_not_longer = repetition_.why_not();
        if (!proof_.repeats) proof_.steps_needed = repetition_.steps_needed();
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m)
            if (restarts(m) != check::Restarts::never) compare_restarted(m);
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m)
            if (restarts(m) == check::Restarts::when_final) compare_restarted(m);
        if (proof_.fault) return;
        const Together together = answers_.together();
        proof_.together = together.is_proved ? together.steps : 0;
        while (const auto window = answers_.window()) take(*window);
        if (proof_.long_windows.empty()) return;
        proof_.repeats.reset();
        proof_.why_not_longer = "what is assumed of its windows was compared in these steps only";
    }

    bool forgets() const { return forgets_; }

private:
    enum class Kind : std::uint8_t { known, missing };

    /// A verdict that comes next, and what it is about.
    struct Place {
        std::uint32_t monitor;
        std::uint32_t step;
        std::uint32_t position;
        bool decided;
        std::uint32_t finishes = 0;
        std::optional<std::uint32_t> restarted{};
    };

    check::Restarts restarts(std::uint32_t m) const { return plan_.monitors[m].restarts; }

    /// Returns what later verdicts are compared with, besides the definition.
    std::vector<Diagram> compared_later() {
        std::vector<Diagram> result;
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) {
            const Bounds& promised = promised_[{m, Kind::missing}];
            result.insert(result.end(), {promised.lower, promised.upper});
        }
        return result;
    }

    void compare_step(std::uint32_t step, Kind kind) {
        for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) compare(place(m, step), kind);
    }

    Place place(std::uint32_t m, std::uint32_t step) const {
        const plan::Monitor& monitor = plan_.monitors[m];
        const bool decided = !monitor.sliding || step >= monitor.horizon;
        return {m, step, monitor.sliding && decided ? step - monitor.horizon : 0, decided};
    }

    /// "`finish()` reports the last h positions, cut at the end of the trace, one per call"
    void compare_finishes(std::uint32_t step) {
        std::uint32_t calls = 0;
        for (const plan::Monitor& monitor : plan_.monitors)
            calls = std::max(calls, monitor.horizon);
        for (std::uint32_t call = 0; plan_.has_sliding && call < calls; ++call)
            for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) {
                Place at = place(m, step);
                at.finishes = call + 1;
                if (const std::uint32_t h = plan_.monitors[m].horizon; plan_.monitors[m].sliding) {
                    at.decided = call < h && step + 1 + call >= h;
                    at.position = at.decided ? step + 1 + call - h : 0;
                }
                compare(at, Kind::missing);
            }
    }

    void compare_restarted(std::uint32_t restarted) {
        for (std::uint32_t at = 1; at < proof_.steps && !proof_.fault; ++at) {
            promised_.clear();
            for (std::uint32_t step = at; step < proof_.steps && !proof_.fault; ++step)
                for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) {
                    Place here = place(m, step);
                    if (m == restarted) here.position = at;
                    if (m == restarted) here.restarted = at;
                    compare(here, Kind::missing);
                }
            if (!proof_.fault) forgets_ = answers_.forgotten() && forgets_;
        }
    }

    void compare(const Place& at, Kind kind) {
        if (proof_.fault) return;
        const Numbers found = answers_.verdict();
        ++proof_.verdicts;
        Numbers expected;
        if (at.decided)
            expected =
                (kind == Kind::known ? known_ : all_).verdict(at.monitor, at.step, at.position);
        // The runs with restarts, which the machine does not take, come after all steps.
        const bool is_taken = kind == Kind::missing && done_ < proof_.steps;
        if (is_taken && at.decided) repetition_.check(at.monitor, at.position, expected);
        if (found.decided != expected.decided) return blame(at, "whether it is decided", Witness());
        if (!found.decided) return;
        check(at, kind, "robustness", found.low, expected.low);
        // Only its sign is seen, in the status.
        check(at, kind, "the greatest possible robustness", found.high, expected.high, true);
        if (plan_.monitors[at.monitor].sliding) {
            check(at, kind, "lower", found.lower, expected.lower);
            check(at, kind, "upper", found.upper, expected.upper);
        } else if (at.finishes == 0) {
            check_bounds(at, kind, found, expected);
            last_[at.monitor] = found;
        } else {  // "a prefix monitor repeats its last verdict"
            check(at, kind, "lower", found.lower, last_[at.monitor].lower);
            check(at, kind, "upper", found.upper, last_[at.monitor].upper);
        }
    }

    /// Bounds may be tighter than the definition's, if no later verdict leaves them.
    void check_bounds(const Place& at, Kind kind, const Numbers& found, const Numbers& expected) {
        const auto least = [&](Diagram a, Diagram b) { return space_.diagrams.both(a, b); };
        check(at, kind, "lower", least(found.lower, expected.lower), expected.lower);
        check(at, kind, "upper", least(found.upper, expected.upper), found.upper);
        Bounds& promised = promised_[{at.monitor, kind}];
        check(at, kind, "the robustness, which an earlier lower bound exceeds,",
              least(promised.lower, found.low), promised.lower);
        check(at, kind, "the robustness, which exceeds an earlier upper bound,",
              least(promised.upper, found.high), found.high);
        if (found.lower != expected.lower)
            promised.lower = space_.diagrams.either(promised.lower, found.lower);
        if (found.upper != expected.upper) promised.upper = least(promised.upper, found.upper);
    }

    void check(const Place& at, Kind kind, const std::string& name, Diagram found, Diagram expected,
               bool at_zero = false) {
        if (proof_.fault || found == expected) return;
        const auto witness = difference(space_, found, expected, proof_.atoms, at.step + 1,
                                        proof_.steps, kind == Kind::missing, at_zero);
        if (witness) return blame(at, name, *witness);
        if (kind == Kind::missing && !at.restarted)
            repetition_.is_inexact(!at_zero &&
                                   are_equal_in_ranges(space_, found, expected, proof_.atoms));
    }

    void take(const Window& window) {
        if (!window.is_two_windows && !window.is_too_long)
            throw Ended{Ended::Why::failed,
                        fmt::format("mixes up its windows of {} steps where samples are missing",
                                    window.length)};
        (window.is_too_long ? proof_.long_windows : proof_.windows).push_back(window.length);
    }

    void blame(const Place& at, const std::string& number, Witness witness) {
        proof_.fault = Fault{at.monitor,   at.step, at.position,       at.finishes,
                             at.restarted, number,  std::move(witness)};
    }

    const plan::Plan& plan_;
    Proof& proof_;
    Space space_;
    Symbol::Scope scope_;
    Answers answers_;
    Definition known_;
    Definition all_;
    Repetition repetition_;
    /// The tightest bounds that a monitor has given so far, of those that the definition lacks.
    struct Bounds {
        Diagram lower = etlprove::kNever;
        Diagram upper = etlprove::kAlways;
    };
    std::map<std::pair<std::uint32_t, Kind>, Bounds> promised_;
    std::map<std::uint32_t, Numbers> last_;  ///< verdict of each prefix monitor
    std::uint32_t& done_;
    bool forgets_ = true;
};

diag::Failure no_proof(std::string why) {
    return {diag::Code::no_proof, std::move(why)};
}

}  // namespace

std::uint32_t usual_steps(const plan::Plan& plan) {
    std::uint32_t horizon = 0;
    std::uint32_t buffer = 0;
    for (const plan::Monitor& monitor : plan.monitors) horizon = std::max(horizon, monitor.horizon);
    for (const plan::Stream& stream : plan.streams) buffer = std::max(buffer, stream.length);
    return std::max(64U, 2 * horizon + buffer);
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

namespace {

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
diag::Result<Proof> prove_with(const std::set<float>& numbers, const plan::Plan& plan,
                               const Program& program, Proof proof) {
    const auto child = program.start(numbers, proof.steps);
    if (!child) return no_proof("cannot run the program that was compiled for the proof");
    std::uint32_t done = 0;
    try {
        Comparison comparison(plan, numbers, proof, *child, done);
        comparison.run();
        proof.restarts = comparison.forgets();
        return proof;
    } catch (const Exhausted&) {
        return no_proof("the diagrams of the definition are too large" + how_far(done));
    } catch (const Ended& ended) {
        return no_proof(why(ended) + how_far(done));
    }
}

/// Makes the proof, and adds to the numbers what it needs.
diag::Result<Proof> prove_steps(std::set<float>& numbers, const plan::Plan& plan,
                                const Program& program, const Proof& proof) {
    constexpr std::size_t kMostNumbers = 10000;
    while (numbers.size() < kMostNumbers) {
        try {
            return prove_with(numbers, plan, program, proof);
        } catch (const NewNumber& unknown) {
            add(numbers, unknown.number);
        }
    }
    return no_proof("the class has too many numbers");
}

/// The most steps of a proof that goes on until the class repeats.
constexpr std::uint32_t kMostStepsToGoOn = 256;

}  // namespace

diag::Result<Proof> prove(const plan::Plan& plan, const Request& request) {
    if (plan.values == check::Values::boolean) return prove_boolean(plan, request);
    Proof proof;
    proof.atoms = atoms_of(plan);
    proof.steps = request.steps > 0 ? request.steps : usual_steps(plan);
    const auto program = Program::make(plan, {request.header, request.name_space}, proof.atoms);
    if (!program) return program.failure();
    proof.compiler = program->compiler();
    if (may_hide_state(request.header))
        proof.why_not_longer = "its header may have variables besides the members of the class";
    std::set<float> numbers = numbers_of(proof.atoms);
    auto found = prove_steps(numbers, plan, *program, proof);
    if (!found || found->fault || found->repeats || request.steps > 0) return found;
    if (found->steps_needed <= proof.steps || found->steps_needed > kMostStepsToGoOn) return found;
    proof.steps = found->steps_needed;
    auto longer = prove_steps(numbers, plan, *program, proof);
    if (longer && (longer->fault || longer->repeats)) return longer;
    if (longer) found->why_not_longer = longer->why_not_longer;
    return found;
}

}  // namespace etlc::prove
