#include "prove/boolean.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "prove/program.hpp"
#include "prove/text/cones.hpp"

namespace etlc::prove {
namespace {

using etlprove::kAlways;
using etlprove::kNever;

/// Compares the verdicts of one class with their definition, in the order in which its program
/// gives them.
class BooleanComparison {
public:
    /// `done`: counts the steps whose verdicts were compared.
    BooleanComparison(const plan::Plan& plan, Proof& proof, const std::vector<Truths>& truths,
                      data::Child& child, std::uint32_t& done)
        : plan_(plan),
          proof_(proof),
          truths_(truths),
          places_(truth_places(plan, proof.atoms, proof.steps)),
          scope_(space_),
          answers_(child, space_),
          definition_(plan, proof.atoms, truths, space_, places_),
          done_(done),
          promised_(plan.monitors.size()) {}

    /// Throws Ended and Exhausted.
    void run() {
        for (; done_ < proof_.steps && !proof_.fault; ++done_) {
            for (std::uint32_t m = 0; m < plan_.monitors.size(); ++m) compare_step(m, done_);
            definition_.forget(done_);
        }
        for (std::uint32_t m = 0; m < plan_.monitors.size() && !proof_.fault; ++m)
            while (!proof_.fault && answers_.forgotten()) compare_later_episode(m);
    }

private:
    /// Verdicts that come next, and what they are about.
    struct Place {
        std::uint32_t monitor;
        std::uint32_t step;
        std::uint32_t finishes = 0;
    };
    /// When a monitor that began at a step was said to be final, though not by the definition.
    struct Promise {
        Diagram satisfied = kNever;
        Diagram violated = kNever;
    };

    Diagram both(Diagram a, Diagram b) { return space_.diagrams.both(a, b); }
    Diagram either(Diagram a, Diagram b) { return space_.diagrams.either(a, b); }
    Diagram no(Diagram a) { return space_.diagrams.complement(a); }

    void compare_later_episode(std::uint32_t m) {
        promised_[m].clear();
        for (std::uint32_t step = 0; step < proof_.steps && !proof_.fault; ++step) {
            compare_step(m, step);
            definition_.forget(step);
        }
    }

    void compare_step(std::uint32_t m, std::uint32_t step) {
        compare_all({m, step});
        for (std::uint32_t call = 1; call <= finishes_of(plan_); ++call)
            compare_all({m, step, call});
    }

    void compare_all(const Place& at) {
        if (proof_.fault) return;
        Diagram covered = kNever;
        while (const auto found = answers_.status()) {
            covered = either(covered, found->condition);
            ++proof_.verdicts;
            compare(at, *found);
            if (proof_.fault) return;
        }
        if (covered != kAlways) throw Ended{Ended::Why::failed, "leaves out a case"};
    }

    void compare(const Place& at, const Status& found) {
        const plan::Monitor& monitor = plan_.monitors[at.monitor];
        if (!monitor.sliding && at.finishes > 0)  // "prefix monitors repeat their verdict"
            return check(at, found, "repeated", no(found.satisfied), kAlways);
        std::uint32_t position = found.begun;
        bool decided = true;
        if (monitor.sliding) {
            // "`finish()` reports the last h positions, cut at the end of the trace, one per call"
            const std::uint32_t h = monitor.horizon;
            decided = at.step + at.finishes >= h && at.finishes <= h;
            position = decided ? at.step + at.finishes - h : 0;
        }
        check(at, found, "decided", found.decided, decided ? kAlways : kNever);
        const Statuses expected =
            decided ? definition_.verdict(at.monitor, at.step, position) : Statuses();
        check(at, found, "satisfied", found.satisfied, expected.satisfied);
        check(at, found, "violated", found.violated, expected.violated);
        check_final(at, found, expected);
    }

    /// It may be final earlier than by the definition, if no later verdict contradicts it.
    void check_final(const Place& at, const Status& found, const Statuses& expected) {
        const Diagram due = both(found.condition, expected.final);
        check(at, found, "final", both(found.final, due), due);
        const Diagram early = both(found.final, no(due));
        if (early != kNever) {
            check(at, found, "both final and unknown",
                  both(early, no(either(found.satisfied, found.violated))), kNever);
            Promise& promise = promised_[at.monitor][found.begun];
            promise.satisfied = either(promise.satisfied, both(early, found.satisfied));
            promise.violated = either(promise.violated, both(early, found.violated));
        }
        check_promises(at, found);
    }

    /// Later verdicts about the same position, also after the monitor has begun again.
    void check_promises(const Place& at, const Status& found) {
        for (const auto& [begun, promise] : promised_[at.monitor]) {
            const Statuses now = definition_.verdict(at.monitor, at.step, begun);
            check(at, found, "final, and later no longer satisfied",
                  both(promise.satisfied, no(now.satisfied)), kNever);
            check(at, found, "final, and later no longer violated",
                  both(promise.violated, no(now.violated)), kNever);
        }
    }

    /// Compares a bit where the monitor began at that step.
    void check(const Place& at, const Status& of, const std::string& name, Diagram found,
               Diagram expected) {
        if (proof_.fault) return;
        const Diagram within = both(of.condition, expected);
        const Diagram differ = space_.diagrams.differ(both(of.condition, found), within);
        if (differ == kNever) return;
        Fault fault;
        fault.monitor = at.monitor;
        fault.step = at.step;
        fault.position = of.begun;
        fault.finishes = at.finishes;
        fault.number = name;
        find_truths(fault, space_.diagrams, differ, plan_, proof_.atoms, truths_, places_);
        fault.witness.first_reaches = both(differ, within) == kNever;
        proof_.fault = std::move(fault);
    }

    const plan::Plan& plan_;
    Proof& proof_;
    const std::vector<Truths>& truths_;
    etlprove::TruthPlaces places_;
    Space space_{std::set<float>{}};
    Symbol::Scope scope_;
    Answers answers_;
    BooleanDefinition definition_;
    std::uint32_t& done_;
    std::vector<std::map<std::uint32_t, Promise>> promised_;  ///< [monitor], by the step it began
};

diag::Failure no_boolean_proof(std::string why) {
    return {diag::Code::no_proof, std::move(why)};
}

/// Returns nothing where reset() leaves something of an earlier episode.
std::optional<diag::Result<Proof>> compare(const plan::Plan& plan, const Program& program,
                                           Proof proof, const std::vector<Truths>& truths) {
    const auto child = program.start({}, proof.steps);
    if (!child) return no_boolean_proof("cannot run the program that was compiled for the proof");
    std::uint32_t done = 0;
    try {
        BooleanComparison(plan, proof, truths, *child, done).run();
        proof.restarts = true;
        proof.together = proof.steps;
        return proof;
    } catch (const Exhausted&) {
        return no_boolean_proof("the diagrams of the definition are too large" + how_far(done));
    } catch (const Ended& ended) {
        if (ended.why == Ended::Why::leftovers) return std::nullopt;
        return no_boolean_proof(why(ended) + how_far(done));
    }
}

/// Returns a robustness of an atom that is true, or false, in its range and as far from the
/// threshold as the threshold from 0, so that it is not rounded to it.
float robustness_of(const plan::Plan& plan, const Atom& atom, bool truth) {
    if (atom.is_truth) return truth ? INFINITY : -INFINITY;
    const float far = std::max(1.0F, std::abs(plan.model->predicates[atom.index].threshold.value));
    return std::clamp(truth ? far : -far, static_cast<float>(atom.range.lowest),
                      static_cast<float>(atom.range.highest));
}

}  // namespace

void find_truths(Fault& fault, const etlprove::Diagrams& diagrams, Diagram condition,
                 const plan::Plan& plan, const std::vector<Atom>& atoms,
                 const std::vector<Truths>& truths, const etlprove::TruthPlaces& places) {
    std::map<Place, bool> chosen;
    while (condition != kAlways) {  // a known sample and no restart, where there is a choice
        const etlprove::Diagrams::Node node = diagrams[condition];
        const Place in_step = (node.place - etlprove::kFirstSample) % places.per_step();
        const bool prefers = in_step < 2 * places.atoms && in_step % 2 == 1;
        const bool with = prefers ? node.with != kNever : node.without == kNever;
        chosen[node.place] = with;
        condition = with ? node.with : node.without;
    }
    const auto is = [&](Place place, bool otherwise) {
        const auto found = chosen.find(place);
        return found == chosen.end() ? otherwise : found->second;
    };
    for (std::uint32_t step = 0; step <= fault.step; ++step) {
        fault.witness.values.emplace_back();
        for (std::uint32_t a = 0; a < atoms.size(); ++a) {
            const Place place = places.atom(step, a);
            const bool high =
                truths[a] == Truths::yes || (truths[a] != Truths::no && is(place, false));
            const bool low = truths[a] == Truths::any ? high && is(place + 1, true) : high;
            std::optional<float> value;
            if (low) value = robustness_of(plan, atoms[a], true);
            if (!high) value = robustness_of(plan, atoms[a], false);
            fault.witness.values.back().push_back(value);
        }
        for (std::uint32_t m = 0; m < places.monitors; ++m)
            if (is(places.restart(step, m), false)) fault.requests.emplace_back(m, step);
    }
}

diag::Result<Proof> prove_boolean(const plan::Plan& plan, const Request& request) {
    Proof proof;
    proof.atoms = atoms_of(plan);
    proof.steps = request.steps > 0 ? request.steps : usual_steps(plan);
    proof.why_not_longer = "a class of truth values is proved step by step";
    const std::vector<Truths> truths = truths_of(plan, proof.atoms);
    try {
        const std::string truths_text = text_of_truths();
        for (const bool may_freeze : {true, false}) {
            const auto program = Program::make(
                {request.header},
                boolean_main(plan, request, proof.atoms, truths, proof.steps, may_freeze),
                "-Istand_in/boolean -Iruntime -Istand_in",
                {{"boolean/etlmon/temporal/truth.hpp", truths_text}});
            if (!program) return program.failure();
            proof.compiler = program->compiler();
            if (auto result = compare(plan, *program, proof, truths)) return std::move(*result);
        }
        return no_boolean_proof("the class keeps something of an episode after reset()");
    } catch (const Unreadable& text) {
        return no_boolean_proof(
            fmt::format("the text of the class is not as etlc writes it: {}", text.what));
    }
}

}  // namespace etlc::prove
