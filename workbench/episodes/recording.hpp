// Reads a recorded episode frame by frame: the samples that the monitor would have got, and the
// labels of predicates. A Boolean array `truth.NAME` in the episode replaces the spec's `truth
// NAME`. Memory is that of one frame and of the windows of truths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artifacts/embedded.hpp"
#include "check/model/model.hpp"
#include "data/files/hash.hpp"
#include "data/spill/spill.hpp"
#include "diag/diag.hpp"
#include "episodes/labels/labels.hpp"
#include "episodes/leaks/leaks.hpp"
#include "episodes/truth.hpp"
#include "execute/evaluator.hpp"
#include "execute/inputs.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"

namespace etlc::episodes {

/// Hashes the samples of an episode as the monitor sees them. Two files of one recording hash alike
/// where the monitor could not distinguish them: float16 is rounded, missing samples are missing
/// however they are written, `hold` replaces them, a bool is true or false, and a zero has no sign.
class Seen {
public:
    /// The model outlives it.
    Seen(const check::Model& model, std::vector<Index> inputs);

    /// Adds the next frame; `samples`: by index of the model's inputs.
    void add(const std::vector<execute::Sample>& samples);
    /// Returns the identity of the frames so far.
    Identity identity() const { return {hash_.text(), hash_.content()}; }
    /// Returns a text that names the inputs with all of their declarations.
    std::string inputs() const;

private:
    struct Held {
        std::vector<float> values;
        std::uint32_t age = 0;  ///< missing samples since then
    };
    void see(const check::Input& input, const execute::Sample& sample, Held& held,
             std::vector<float>& seen) const;

    const check::Model& model_;
    std::vector<Index> inputs_;
    std::vector<Held> held_;                ///< per input, the last present sample
    std::vector<std::vector<float>> seen_;  ///< per input, of this frame; empty where missing
    recordings::EpisodeHash hash_;
};

/// The frames of an episode, in order, from a file (Recording) or from memory.
class Frames {
public:
    virtual ~Frames() = default;

    /// Reads the next frame; returns false at the end of the episode.
    virtual diag::Result<bool> next() = 0;
    /// Returns the samples of this frame by index of the model's inputs; unwanted ones are absent,
    /// and stale ones.
    virtual const std::vector<execute::Sample>& samples() const = 0;
    /// Returns the label of a wanted predicate in this frame.
    virtual Label label(Index predicate) const = 0;
    /// Returns the number of frames so far.
    virtual std::uint64_t frames() const = 0;
};

struct Wanted {
    const check::Model* model = nullptr;
    std::vector<Index> inputs;      ///< inputs of the model to read
    std::vector<Index> predicates;  ///< named predicates whose labels are wanted
    std::vector<Index> identity;    ///< inputs in the hash; all are in `inputs` too
    const Leaks* leaks = nullptr;   ///< targets that no frame may equal; null: no check
    std::vector<Index> optional{};  ///< inputs to read from episodes that have them
    /// Per predicate, the steps before and from a change of its label at which it is unknown;
    /// empty: none. Labels are then read ahead, so the episode is read twice.
    std::vector<std::uint32_t> within{};
};

/// Returns whether an input needs an encoder that the episode's marks do not name.
bool is_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                 const recordings::NamesInFile& names, const embedded::Marks& marks);

/// The identity of an episode that has been read.
struct Recorded {
    std::string path;
    std::string group;  ///< of labels beside the episode; empty: none
    Outcome outcome;    ///< likewise
    std::string hash;   ///< 16 hex digits
    data::EpisodeContent content;
    std::uint64_t frames = 0;
    std::optional<Leak> leak;    ///< the first leak
    std::vector<NearLeak> near;  ///< judged by LeakEvidence
    bool is_unmarked = false;    ///< it does not name the encoder of its embeddings
};

template <class Archive>
void fields(Archive& archive, Recorded& recorded) {
    archive(recorded.path, recorded.group, recorded.outcome, recorded.hash, recorded.content,
            recorded.frames, recorded.leak, recorded.near, recorded.is_unmarked);
}

/// Returns the hash as a number, as in files of thresholds and of fitted things.
inline std::uint64_t hash_of(const Recorded& recorded) {
    return data::hash_of_text(recorded.hash).value_or(0);  // always valid in an EpisodeHash
}

/// The identities of all episodes of a call, in order.
using Identities = data::Spool<Recorded>;

/// Returns the identities of episodes.
template <class Episodes>
Identities recorded(const Episodes& episodes) {
    Identities result;
    for (const Recorded& episode : episodes) result.add(episode);
    return result;
}

/// Returns the inputs of predicates with a calibrated threshold, in order of their names: episodes
/// that agree in these give equal scores. Without such a predicate, returns the inputs of all.
std::vector<Index> identity_inputs(const check::Model& model);

/// Returns the predicates with a truth in the spec, an array in this episode, or labels beside any
/// episode of the call. Failures do not name the path.
diag::Result<std::vector<Index>> labelled_in(const check::Model& model, const std::string& path,
                                             const ReadOptions& options);

/// Opens an episode with these channels.
using Opener =
    std::function<diag::Result<std::unique_ptr<data::Trace>>(const std::vector<data::Channel>&)>;

/// Returns an opener in place of another.
using Wrap = std::function<Opener(const Opener&)>;

class Recording final : public Frames {
public:
    /// Opens an episode. Fails as opening the trace does, or with no_label where a predicate has
    /// neither a truth nor an array. Failures do not name the episode. `wrap`: null, or what to
    /// make of the opener of the file.
    static diag::Result<Recording> open(const Wanted& wanted, const std::string& path,
                                        const ReadOptions& options, const Wrap& wrap = nullptr);
    static diag::Result<Recording> open(const Wanted& wanted, const Opener& open);

    diag::Result<bool> next() override;
    const std::vector<execute::Sample>& samples() const override { return samples_; }
    Label label(Index predicate) const override;
    /// Returns the label as recorded, near a change too.
    Label recorded_label(Index predicate) const;
    /// Returns whether its labels come from an array of the episode, or from beside it.
    bool from_array(Index predicate) const { return sources_[predicate].from_array; }

    /// Returns whether the episode has all optional inputs.
    bool is_complete() const { return is_complete_; }

    std::uint64_t frames() const override { return frames_; }
    /// Returns the number of frames if the file gives it, else 0.
    std::uint64_t length() const { return trace_->length(); }
    const Outcome& outcome() const { return outcome_; }
    /// Returns the identity of the frames so far, over the inputs of `identity`; of all frames
    /// where it was known before.
    Recorded recorded() const {
        const Identity identity = known_ ? *known_ : seen_.identity();
        return {path_,   group_, outcome_, identity.hash, identity.content,
                frames_, leak_,  near_,    is_unmarked_};
    }

private:
    struct Source {
        bool from_array = false;
        std::size_t channel = 0;  ///< channel of the array
        Index formula = check::kNone;
    };

    explicit Recording(const Wanted& wanted)
        : model_(wanted.model), leaks_(wanted.leaks), seen_(*wanted.model, wanted.identity) {}

    diag::Result<bool> narrow();
    /// Reads the labels of all frames, where some are unknown near a change.
    std::optional<diag::Failure> read_ahead(const Wanted& wanted, const Opener& open);

    const check::Model* model_;
    const Leaks* leaks_;
    std::string path_;
    std::string group_;
    Outcome outcome_;
    bool is_unmarked_ = false;
    bool is_complete_ = true;
    Seen seen_;
    std::shared_ptr<IdentityCache> identities_;  ///< null: the episode is not kept
    std::shared_ptr<const Identity> known_;      ///< null: `seen_` computes it
    std::unique_ptr<data::Trace> trace_;
    std::vector<Index> channel_inputs_;  ///< per channel of an input, the input
    std::vector<bool> narrowed_;         ///< per such channel: whether its samples are wanted
    std::vector<execute::Freshness> freshness_;  ///< per such channel
    std::vector<Source> sources_;                ///< per predicate of the model
    std::unique_ptr<TruthEvaluator> truth_;
    data::Sample sample_;
    std::vector<execute::Sample> samples_;
    Frame frame_;
    std::uint64_t frames_ = 0;
    std::vector<std::vector<Label>> ahead_;  ///< per predicate, of all frames, if read ahead
    std::optional<Leak> leak_;
    std::vector<NearLeak> near_;
};

/// Points of the frames of an episode, as they were recorded: of the last frame, and of those
/// before it that points of earlier steps need.
class RecentFrames {
public:
    /// `points`: those that will be read, without projections inside of what is put together.
    RecentFrames(const check::Model& model, const std::vector<Index>& points);

    /// Begins another episode.
    void reset() {
        last_ = nullptr;
        frames_.clear();
    }
    /// Adds a frame; per input of the model its sample. The samples of the last frame outlive the
    /// calls of `read`: they are copied only where points of earlier steps need them.
    void push(const std::vector<execute::Sample>& samples);
    /// Reads a point at the last frame; returns false where a sample is missing, or not finite or
    /// in range.
    bool read(Index point, std::vector<float>& values) const;

private:
    bool append(Index point, std::size_t ago, std::vector<float>& values) const;
    bool append_sum(const check::Point& point, std::size_t ago, std::vector<float>& values) const;

    const std::vector<execute::Sample>* at(std::size_t ago) const;

    const check::Model& model_;
    std::vector<Index> inputs_;
    std::size_t most_ = 0;  ///< frames before the last that some point needs
    const std::vector<execute::Sample>* last_ = nullptr;
    std::deque<std::vector<execute::Sample>> frames_;  ///< if most_ > 0; the last one first
};

// ---- monitors beside a recording ----------------------------------------------------------------
// Runs a recorded episode through monitors, of a spec or of its ground truth, step by step. Every
// plan gets the samples that its generated class would get; after the last frame sliding monitors
// report the remaining positions.

/// Steps a plan through episodes. The arguments outlive it.
class Follower {
public:
    /// `truth`: set for a plan of the ground truth, whose inputs include the labels.
    explicit Follower(const plan::Plan& plan, const GroundTruth* truth = nullptr);

    execute::Evaluator& evaluator() { return evaluator_; }
    const execute::Evaluator& evaluator() const { return evaluator_; }
    const plan::Plan& plan() const { return plan_; }

    /// Returns the verdicts of the last step, by index of the plan's monitors.
    const std::vector<etlmon::Verdict>& verdicts() const { return *verdicts_; }
    /// Returns the verdict of the last step, by index of the model's monitors.
    const etlmon::Verdict& verdict(Index monitor) const { return verdicts()[places_[monitor]]; }
    /// Returns whether that verdict is decided and new: after the last frame, a prefix monitor
    /// repeats its last one.
    bool reports(Index monitor) const;

    void reset() { evaluator_.reset(); }
    /// Restarts a monitor of the model with the next step.
    void restart(Index monitor) { evaluator_.restart(places_[monitor]); }
    void step(const Frames& recording);
    /// Reports the next position after the last frame.
    void finish();

private:
    const plan::Plan& plan_;
    const GroundTruth* truth_;
    std::vector<Index> labelled_;      ///< predicates with labels in the ground truth
    std::vector<std::size_t> places_;  ///< per monitor of the model, its index in the plan
    execute::Evaluator evaluator_;
    std::vector<execute::Sample> samples_;  ///< samples with the labels
    const std::vector<etlmon::Verdict>* verdicts_ = nullptr;
    bool finished_ = false;
};

/// Returns what to read of an episode for these plans of the model or of its ground truth: their
/// inputs, those of the hash, and the labels of `predicates`.
Wanted wanted(const check::Model& model, const std::vector<const plan::Plan*>& plans,
              std::vector<Index> predicates, const Leaks& leaks);

/// Called after each step of all followers; returns false to stop.
using AfterStep = std::function<bool()>;

/// Steps followers through all frames, with `frame` after each; then, if given `rest`, through the
/// positions that the end leaves open, with `rest` after each. Returns whether it reached the end.
diag::Result<bool> replay(Frames& recording, const std::vector<Follower*>& followers,
                          const AfterStep& frame, const AfterStep& rest = nullptr);

}  // namespace etlc::episodes
