// One episode as the page shows it: what was measured, predicted and true at every step, and
// explanations of the verdicts. The evaluator of `etlc run` runs the monitors, on the samples that
// the generated class would get.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "episodes/recording.hpp"
#include "evaluate/episode_scores.hpp"
#include "explain/report.hpp"
#include "ir/lower.hpp"
#include "report/pictures.hpp"

namespace etlc::report {

using check::Index;

/// The plane of greatest variance of a point of the spec, from some of its frames. Frames count by
/// their direction if only angles are measured from the point. The same frames give the same bits.
struct Plane {
    Index point = 0;  ///< in the model
    bool by_direction = false;
    std::vector<double> mean;
    std::array<std::vector<double>, 2> axes;
    std::array<double, 2> explained{};  ///< shares of the variance, 0 to 1

    std::array<float, 2> operator()(const float* z) const;
};

/// Returns the planes of the points of several numbers from which the predicates measure, in the
/// model's order, from evenly chosen frames of some episodes. A point with fewer than two known
/// frames has none. Failures do not name the path.
diag::Result<std::vector<Plane>> planes(const check::Model& model,
                                        const std::vector<Index>& predicates,
                                        const std::vector<std::string>& paths,
                                        const episodes::ReadOptions& reading);

/// The parts of a spec that the page shows.
struct Scene {
    const plan::Plan& plan;
    std::vector<Index> predicates;   ///< shown on the page
    const evaluate::Subject* truth;  ///< null without truths
    const plan::Plan* truth_plan;    ///< of the ground truth; null without truths
    const episodes::ReadOptions& reading;
    std::vector<Plane> planes;  ///< of the points drawn
    TargetPictures target_pictures;
};

/// A series of numbers, one per step. `of`: distance, robustness, lower, upper, x, y.
struct Numbers {
    std::string of;
    std::size_t index = 0;  ///< in the scene's predicates, the plan's monitors or the planes
    std::vector<float> values;
};

/// A series of codes, one per step. `of`: holds, nearest, truth, input, status, monitor_truth.
struct Codes {
    std::string of;
    std::size_t index = 0;
    std::vector<std::uint32_t> values;
};

// Codes of truths, bools and verdicts.
inline constexpr std::uint32_t kNo = 0;
inline constexpr std::uint32_t kYes = 1;
inline constexpr std::uint32_t kUnknown = 2;
inline constexpr std::uint32_t kUndecided = 3;
inline constexpr std::uint32_t kFinal = 4;  ///< added to a final verdict

/// Return the code of a verdict, and of what a predicate is called.
std::uint32_t code_of(const etlmon::Verdict& verdict);
std::uint32_t code_of(const std::optional<bool>& called);

/// Returns the one or two thresholds, ascending, as Number() of JavaScript reads them.
std::vector<std::string> levels(const check::Threshold& threshold);

/// The outcome of a monitor.
struct Outcome {
    std::uint32_t status = kUndecided;   ///< code of its last verdict; the worst of a sliding one
    float robustness = 0;                ///< of that verdict; the least of a sliding monitor
    std::optional<std::uint64_t> alarm;  ///< first step with a final violation
    std::optional<std::uint64_t> final_at;  ///< first step with a final verdict
};

/// Successive samples of a predicate or a bool that explain a verdict.
struct Mark {
    bool is_predicate = true;
    std::size_t index = 0;  ///< in the scene's predicates or the plan's inputs
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool holds = false;
};

/// The explanation of a verdict.
struct Why {
    std::size_t monitor = 0;  ///< in the plan
    std::uint64_t step = 0;
    std::uint64_t position = 0;
    std::string status;
    bool for_good = false;
    std::string text;  ///< text of `etlc explain`
    std::vector<Mark> samples;
    std::optional<Mark> critical;  ///< one step
};

struct Tracks {
    std::string path;
    std::uint64_t frames = 0;
    std::vector<Outcome> outcomes;                     ///< per monitor of the plan
    std::vector<execute::SampleCounts> sample_counts;  ///< per input of the plan
    std::vector<Numbers> numbers;
    std::vector<Codes> codes;
    std::vector<Why> reasons;
};

/// Returns the steps whose pictures tell most, these first: where something is called wrong,
/// of the samples that explain the verdicts, then where a truth, a verdict or a bool changes.
std::vector<std::uint64_t> telling_steps(const Tracks& tracks);

/// Reads one episode after the other, on one thread. The scene must outlive it.
class TrackReader {
public:
    explicit TrackReader(const Scene& scene);
    TrackReader(const TrackReader&) = delete;
    TrackReader& operator=(const TrackReader&) = delete;

    /// Failures do not name the path.
    diag::Result<Tracks> score(const std::string& path);

private:
    struct MonitorTrack {
        explain::History history;
        std::vector<std::uint32_t> truth;
    };

    episodes::Wanted wanted() const;
    void begin(Tracks& tracks);
    void note_frame(const episodes::Recording& recording, Tracks& tracks);
    void note_truth(std::size_t monitor);
    void add_measurements(Tracks& tracks) const;
    void add_verdicts(Tracks& tracks) const;
    void add_reasons(Tracks& tracks) const;
    Mark mark(explain::Sample sample, std::uint64_t last, bool holds) const;
    const check::Model& model() const { return *scene_.plan.model; }

    const Scene& scene_;
    episodes::Leaks leaks_;
    ir::Program program_;
    episodes::Follower monitors_;
    std::optional<episodes::Follower> truths_;
    std::unique_ptr<explain::Observations> observations_;
    std::optional<episodes::Follower> atoms_;
    std::vector<MonitorTrack> monitor_tracks_;  ///< per monitor of the plan
    std::vector<Index> truth_of_;  ///< per monitor of the plan: monitor of the ground truth
};

}  // namespace etlc::report
