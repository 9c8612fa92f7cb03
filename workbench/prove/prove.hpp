// Proves a generated class: compares it on symbols with the definition of its verdicts.
// Takes: a plan and the text of a header. Gives: a proof for all inputs of a number of steps, an
// input on which the class is wrong, or the reason why neither was found. Keeps true: "proved" is
// said only where every diagram of every verdict was compared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diag/diag.hpp"
#include "emit/standalone.hpp"
#include "plan/plan.hpp"
#include "prove/symbols.hpp"

namespace etlc::prove {

struct Request {
    std::string header;       ///< its text: what etlc generates from the plan
    std::string name_space;   ///< of its class
    std::uint32_t steps = 0;  ///< 0: usual_steps()
    /// Most ways through all steps, on which truths or final verdicts decide; and those of them in
    /// which several monitors restart.
    std::uint64_t most_ways = 4000000;
    std::uint64_t most_together = 30000;
    bool counts_lines = false;  ///< for Proof::coverage
};

/// Twice the longest horizon and the longest buffer, at least 64.
std::uint32_t usual_steps(const plan::Plan& plan);

/// A wrong verdict, on the shortest input that has one.
struct Fault {
    std::uint32_t monitor = 0;  ///< of the plan
    std::uint32_t step = 0;
    std::uint32_t position = 0;  ///< that the verdict is about
    std::uint32_t finishes = 0;  ///< calls of finish() after the step
    std::string number;          ///< "robustness", "lower", "upper" or "whether it is decided"
    Witness witness;
    /// The monitors that were restarted, and before which step.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> restarts;
};

/// Steps after which the class and the definition have the same form.
struct Repeats {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
};

struct Proof {
    std::vector<Atom> atoms;
    std::uint32_t steps = 0;
    std::uint32_t finishes = 0;               ///< calls of finish() after each step
    std::uint32_t places = 0;                 ///< steps that have variables
    std::string compiler;                     ///< its first line about its version
    std::uint64_t verdicts = 0;               ///< that were compared
    std::uint32_t together = 0;               ///< first steps in which several monitors may restart
    std::vector<std::uint32_t> windows;       ///< lengths of those that were proved to be two
    std::vector<std::uint32_t> long_windows;  ///< and of those that are assumed to be
    std::optional<Repeats> repeats;  ///< then the proof without restarts holds for all lengths
    std::string why_not_longer;      ///< else why it does not
    std::uint32_t steps_needed = 0;  ///< after which it may; 0: nothing is known
    std::string coverage;            ///< JSON of $GCOV, or gcov; empty: there is none
    std::optional<Fault> fault;
};

/// Returns a measurement at which a predicate has this robustness, up to rounding.
float measured(const check::Predicate& predicate, float robustness);

/// Returns the headers that stand in for some of the runtime's, and the program around a class.
const std::vector<emit::RuntimeFile>& stand_in_files();

/// Failures say why there is no proof.
diag::Result<Proof> prove(const plan::Plan& plan, const Request& request);

}  // namespace etlc::prove
