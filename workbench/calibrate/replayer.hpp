// Replays recorded episodes against monitors with other thresholds, without reading them again. A
// track holds what the formulas see of each step, so no distance is measured twice: 4 bytes for
// each predicate, and one for each label (as recorded, and as it counts near a change) and boolean
// input. A broken variant of an episode is its track with the steps in another order.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "check/guarantees/conformal.hpp"
#include "check/guarantees/guarantees.hpp"
#include "compile.hpp"
#include "episodes/recording.hpp"
#include "episodes/truth.hpp"
#include "episodes/variants/variants.hpp"

namespace etlc::calibrate {

using check::Index;

/// A monitor with a guarantee, for its whole formula or for a conjunct.
struct Guaranteed {
    Index monitor = 0;
    check::Guarantee guarantee;
    /// The error that the guarantee leaves open: a verdict that is satisfied wrongly, or violated
    /// wrongly; if both are bounded, one that is unknown.
    enum class Open : std::uint8_t { satisfied, violated, unknown };
    Open open = Open::satisfied;
};

/// Makes it a sample of one number, or a missing one.
void set(execute::Sample& sample, bool present, float value);

/// Appends an input for each of these predicates, in their order, which says whether it was
/// measured, and makes it all that the predicate reads.
void measure_by_inputs(check::Model& model, const std::vector<Index>& predicates);

/// Returns the guarantees for the errors of monitors, of each formula or conjunct once: of those
/// that are calibrated as a whole, or of the others.
std::vector<Guaranteed> guaranteed(const check::Model& model, bool as_a_whole);

/// The parts of a step that a track holds.
struct Watched {
    std::vector<Index> predicates;  ///< what they measure
    std::vector<Index> labelled;    ///< their labels; the other predicates are their own truth
    std::vector<Index> flags;       ///< boolean inputs
    std::vector<Index> dividing;    ///< other predicates whose labels divide episodes into phases

    std::size_t step_size() const {
        return sizeof(float) * predicates.size() + labelled.size() + dividing.size() + flags.size();
    }
};

/// Returns what the formulas of these guarantees see. `labelled`: predicates with labels.
/// `in_all`: those whose labels divide episodes into phases; see episodes::orders.
Watched watched_by(const check::Model& model, const std::vector<Guaranteed>& all,
                   const std::vector<Index>& labelled, const std::vector<Index>& in_all);

/// Appends a step to the track. `is_divided`: the episode has the labels that only divide it.
void add_step(const Watched& watched, const execute::Evaluator& measured,
              const episodes::Recording& recording, bool is_divided, std::string& track);

/// The verdicts of a monitor and of its truth over the steps of an episode whose truth is known.
struct VerdictCounts {
    std::uint64_t all = 0;      ///< steps, of open truth too
    std::uint64_t unknown = 0;  ///< of all
    std::uint64_t steps = 0;
    std::uint64_t satisfied = 0;  ///< according to the monitor
    std::uint64_t violated = 0;
    std::uint64_t truly_satisfied = 0;
    std::uint64_t falsely_satisfied = 0;
    std::uint64_t falsely_violated = 0;
    /// `all` at the first satisfied verdict, and at the first truly satisfied one; 0: none.
    std::uint64_t first_satisfied = 0;
    std::uint64_t first_truly_satisfied = 0;
};

/// The verdict of a monitor on a whole episode and that of its truth: the last one, or that a
/// sliding monitor always holds, or that a repeating one has not raised an alarm. Both are unknown
/// where nothing was judged.
struct Concluded {
    episodes::Label predicted = episodes::Label::unknown;
    episodes::Label actual = episodes::Label::unknown;
    bool began = false;            ///< at least one step was judged
    bool predicted_alarm = false;  ///< a repeating monitor, or its truth, raised an alarm
    bool actual_alarm = false;
};

/// A broken variant of an episode.
struct Broken {
    episodes::Variant variant = episodes::Variant::cut;
    std::vector<Concluded> concluded;  ///< per guarantee
};

/// The thresholds of an episode.
struct Thresholds {
    std::vector<check::Both> predicates;  ///< by index in the model
    std::vector<check::Both> shifts;  ///< per guarantee; read for monitors calibrated as a whole
};

/// Replays one episode after the other, on one thread.
class Replayer {
public:
    /// Returns nothing where the monitors exceed the limits of a plan. `model` has all thresholds
    /// and outlives the replayer.
    static std::unique_ptr<Replayer> make(const check::Model& model, std::vector<Guaranteed> all,
                                          Watched watched);
    Replayer(const Replayer&) = delete;
    Replayer& operator=(const Replayer&) = delete;

    /// Returns the verdicts per guarantee.
    std::vector<VerdictCounts> replay(const std::string& track, const Thresholds& thresholds);
    /// Returns the verdicts on all broken variants of the episode. They are those of the reordered
    /// recording if no input has a state and no truth looks back.
    std::vector<Broken> replay_variants(const std::string& track, const Thresholds& thresholds);

private:
    class Steps;

    Replayer(const check::Model& model, std::vector<Guaranteed> all, Watched watched,
             Compiled monitors, episodes::GroundTruth truth, Compiled truths);

    void run(episodes::Frames& steps, const Thresholds& thresholds,
             const episodes::AfterStep& after_step);
    void follow(Index m);
    void note(std::vector<VerdictCounts>& counts);
    void conclude(std::vector<Concluded>& concluded);

    const check::Model& model_;
    std::vector<Guaranteed> all_;
    Watched watched_;
    Compiled monitor_plan_;
    episodes::GroundTruth truth_;
    Compiled truth_plan_;
    episodes::Follower monitors_;
    episodes::Follower truths_;
    std::vector<float> measured_;  ///< of this step, by index of the model's predicates
    const Thresholds* thresholds_ = nullptr;
};

}  // namespace etlc::calibrate
