// One episode as the page shows it: what was measured, said and true at every step.
// Takes: the compiled spec, which truths to read, and an episode. Gives: its series, what they came
// to, and why each monitor's verdict is what it is. Keeps true: the monitors are run by the
// evaluator of `etlc run`, on the samples that the generated class would get.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "episodes/replay.hpp"
#include "evaluate/subject.hpp"
#include "explain/report.hpp"
#include "ir/lower.hpp"
#include "report/plane.hpp"
#include "report/target_pictures.hpp"

namespace etlc::report {

using check::Index;

/// What the page knows of the spec beside the spec itself.
struct Scene {
    const plan::Plan& plan;
    std::vector<Index> predicates;   ///< that are shown
    const evaluate::Subject* truth;  ///< null: no truths are known
    const plan::Plan* truth_plan;    ///< of the ground truth; null with it
    const data::NamesInFile& names;
    std::vector<Plane> planes;  ///< of the points that are drawn
    TargetPictures target_pictures;
};

/// A number a step. `of`: distance, robustness, lower, upper, x, y.
struct Numbers {
    std::string of;
    std::size_t index = 0;  ///< of the scene's predicates, the plan's monitors, or the planes
    std::vector<float> values;
};

/// A code a step. `of`: holds, nearest, truth, input, status, monitor_truth.
struct Codes {
    std::string of;
    std::size_t index = 0;
    std::vector<std::uint32_t> values;
};

// Codes of truths and bools, and of what monitors say.
inline constexpr std::uint32_t kNo = 0;
inline constexpr std::uint32_t kYes = 1;
inline constexpr std::uint32_t kUnknown = 2;
inline constexpr std::uint32_t kUndecided = 3;
inline constexpr std::uint32_t kFinal = 4;  ///< added, where the verdict is for good

/// What a monitor came to.
struct Outcome {
    std::uint32_t status = kUndecided;      ///< of its last verdict
    float robustness = 0;                   ///< of it; a sliding monitor's least one
    std::optional<std::uint64_t> alarm;     ///< the first step that says violated for good
    std::optional<std::uint64_t> final_at;  ///< the first step that says anything for good
};

/// Samples in a row of a predicate, or of a bool, on which a verdict rests.
struct Mark {
    bool is_predicate = true;
    std::size_t index = 0;  ///< of the scene's predicates, or of the plan's inputs
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    bool holds = false;
};

/// Why a monitor says what it says after a step.
struct Why {
    std::size_t monitor = 0;  ///< of the plan
    std::uint64_t step = 0;
    std::uint64_t position = 0;
    std::string status;
    bool for_good = false;
    std::string text;  ///< of `etlc explain`
    std::vector<Mark> samples;
    std::optional<Mark> critical;  ///< one step
};

struct Tracks {
    std::string path;
    std::uint64_t frames = 0;
    std::vector<Outcome> outcomes;                  ///< per monitor of the plan
    std::vector<plan::SampleCounts> sample_counts;  ///< per input of the plan
    std::vector<Numbers> numbers;
    std::vector<Codes> codes;
    std::vector<Why> reasons;
};

/// Reads one episode after the other. Not shared between threads; the scene outlives it.
class TrackReader {
public:
    explicit TrackReader(const Scene& scene);
    TrackReader(const TrackReader&) = delete;
    TrackReader& operator=(const TrackReader&) = delete;

    /// Failures do not name the path.
    diag::Result<Tracks> score(const std::string& path);

private:
    struct Said {
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
    std::vector<Said> said_;       ///< per monitor of the plan
    std::vector<Index> truth_of_;  ///< per monitor of the plan: of the ground truth's model
};

}  // namespace etlc::report
