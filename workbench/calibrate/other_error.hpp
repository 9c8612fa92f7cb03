// The error that a guarantee does not bound: a predicate that is true where its truth is not, and
// the opposite wrong verdict of a monitor. Against both errors it is the cost instead: how often a
// predicate or a verdict is unknown. It is counted in each demonstration with the thresholds
// that the others give, since thresholds fit the demonstrations that they come from too well. A
// guarantee holds and is empty where its monitor says the same whatever is true. Demonstrations are
// mostly successes, so the monitor is judged on broken variants of them too.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/fit.hpp"
#include "calibrate/replayer.hpp"
#include "data/spill/spill.hpp"
#include "episodes/bootstrap.hpp"

namespace etlc::calibrate {

/// How often an error happens where it can.
struct ErrorShare {
    std::string why;           ///< why it was not counted; empty if it was
    std::uint64_t cases = 0;   ///< frames, steps or variants at which it can happen
    std::uint64_t errors = 0;  ///< those at which it happens
    std::uint64_t groups = 0;  ///< groups of episodes with a case
    std::uint64_t wrong = 0;   ///< groups with an error
    bool by_group = false;     ///< some episode has a group; otherwise each is one
    /// The 95 % interval of errors / cases over the groups, from resamples of them; if all or no
    /// cases are errors, that of Clopper and Pearson ("The use of confidence or fiducial limits",
    /// 1934) for as many groups. Otherwise it takes kLeastGroups.
    std::optional<episodes::Interval> interval{};

    static constexpr std::uint64_t kLeastGroups = 5;

    double share() const { return static_cast<double>(errors) / static_cast<double>(cases); }
};

/// The error in the verdicts on broken variants of the episodes.
struct VariantError : ErrorShare {
    std::array<std::uint64_t, std::size(episodes::kVariants)> made{};  ///< variants of each kind
    /// Against missed alarms, the error that is bounded on episodes: satisfied, truly violated.
    episodes::Fraction missed_alarms;
};

struct OtherError : ErrorShare {
    std::uint64_t all = 0;        ///< monitors: all steps
    std::uint64_t steps = 0;      ///< those of known truth
    std::uint64_t predicted = 0;  ///< those with the wrong verdict, as its cases have if wrong
    std::uint64_t actual = 0;     ///< those at which the truth is that verdict
    std::uint32_t parts = 0;      ///< groups were left out in this many parts; 0: one by one
    VariantError variants;        ///< of a monitor
    /// Against missed alarms: per episode with a truly satisfied step, the number of steps from the
    /// first one to the first satisfied verdict; 0 where this comes before.
    std::vector<std::uint64_t> lateness;
    std::uint64_t never = 0;  ///< such episodes without a satisfied verdict
};

/// The tracks of all episodes, in order.
using Tracks = data::Spool<std::string>;

struct Tracked {
    const Tracks& tracks;
    const Watched& watched;
    const episodes::Groups& groups;
    bool is_complete = true;  ///< every episode has the inputs of all watched predicates and flags
    bool is_divided = true;   ///< every episode has all labels that divide it into phases
};

/// Returns the error of each predicate. `out`: per predicate.
std::vector<OtherError> other_errors(const check::Model& model,
                                     const std::vector<Index>& predicates,
                                     const std::vector<Evidence>& evidence,
                                     const std::vector<LeftOut>& out,
                                     const episodes::Groups& groups);

/// Returns the error of each guarantee. `model` has all thresholds; those of `predicates` are
/// replaced by `out`.
std::vector<OtherError> other_errors(const check::Model& model, const std::vector<Guaranteed>& all,
                                     const std::vector<Index>& predicates,
                                     const std::vector<LeftOut>& out, const Tracked& recorded);

/// Returns the error of each monitor that is calibrated as a whole. `out`: per monitor.
std::vector<OtherError> other_errors_of_shifts(const check::Model& model,
                                               const std::vector<Guaranteed>& all,
                                               const std::vector<LeftOut>& out,
                                               const Tracked& recorded);

/// Describes it in a line: "the other error: true at 12 of 40 negative frames, ...".
std::string describe(const OtherError& error, check::Against against);
/// Describes it in lines, each after `indent`.
std::string describe(const OtherError& error, const Guaranteed& of, const std::string& indent);

/// Whether both errors of some monitor are bounded.
bool has_cost(const std::vector<Guaranteed>& all);
/// Explains these lines at the end of a report.
std::string note_on_other_errors(bool by_group, bool has_cost);

/// Warns of a guarantee that holds and is empty, or whose monitor is wrong on most variants.
void warn_of_empty(const check::Model& model, const Guaranteed& of, const OtherError& error,
                   diag::Sink& sink);

}  // namespace etlc::calibrate
