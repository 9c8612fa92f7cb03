// Calibrated durations (check/formulas/durations.hpp). The score of an episode comes from the
// verdicts of the monitor: it is replayed, without reading the episode again, with one duration
// after the other, by bisection. Predicates are worth the least that any build may measure, so a
// monitor that is not violated for good here is not in any build.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/thresholds.hpp"
#include "check/model/model.hpp"
#include "compile.hpp"
#include "diag/diag.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

using check::Index;

/// A predicate at a step, in the build that is worst for the monitor: keys of its least robustness
/// (`high`), and of the greatest (`low`), whose negation is the least.
struct Ends {
    std::int32_t low = 0;
    std::int32_t high = 0;
};

/// Returns the monitors with a calibrated duration.
std::vector<Index> timed_monitors(const check::Model& model);

/// Scores one monitor in one episode after the other, on one thread. Memory is some bytes for each
/// step of the episode.
class DurationScorer {
public:
    DurationScorer(const check::Model& model, Index monitor);

    void reset();
    /// Adds a step. `values`: per predicate of the model; nothing where it was not measured.
    void add(const std::vector<std::optional<Ends>>& values, const episodes::Frames& frames);
    /// Returns the least duration with which the steps do not violate the monitor for good, +inf
    /// where all do. Where a longer one makes it falser, returns the greatest one, negated: -inf
    /// where none violates it, +inf where all do. Fails where the monitor exceeds the limits of a
    /// plan.
    diag::Result<double> score();

private:
    diag::Result<const Compiled*> with(std::uint32_t steps);
    diag::Result<bool> is_violated(std::uint32_t steps);

    check::Duration duration_;
    check::Model model_;  ///< of this monitor, in which an input stands for each predicate
    std::vector<Index> predicates_;
    std::vector<Index> flags_;
    std::map<std::uint32_t, Compiled> plans_;  ///< by duration, for the next episodes
    std::vector<std::optional<Ends>> values_;  ///< step by step, per element of predicates_
    std::vector<std::optional<bool>> bools_;   ///< likewise of flags_
    std::uint32_t steps_ = 0;
};

/// The worst score of each group of episodes, and whether it is by group that they count.
struct Times {
    std::vector<double> worst;  ///< as DurationScorer gives them, of the groups that have one
    bool by_group = false;
    std::uint64_t failures = 0;  ///< episodes left out since their outcome is no success
    std::map<std::uint32_t, std::size_t> places{};  ///< in `worst`, per group

    void add(double score, std::uint32_t group);
};

/// Returns the duration with its scores, without `reads` and episodes. Returns nothing after an
/// error, which it reports.
std::optional<thresholds::Entry> fit_duration(const check::Monitor& monitor, const Times& times,
                                              diag::Sink& sink);

/// Sets the duration of a monitor of the model.
void set_calibrated(check::Model& model, check::Monitor& monitor, const thresholds::Entry& entry,
                    bool by_group);

/// Describes the calibrated duration of a monitor of `model`, which has it.
std::string describe_duration(const check::Model& model, const check::Monitor& monitor,
                              const thresholds::Entry& entry);

}  // namespace etlc::calibrate
