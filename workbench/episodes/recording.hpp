// One recorded episode, a frame after the other: what the monitor would have been given, and what
// was true. Takes: what is wanted of an episode, and where it lies. Gives: per frame the samples in
// the monitor's precision and the label of every predicate; at the end what tells it from others.
// Keeps true: memory is that of one frame (and of the windows of truths); a Boolean array
// `truth.NAME` in the episode stands in for the spec's `truth NAME`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/files/hash.hpp"
#include "data/recordings/episodes.hpp"
#include "data/recordings/open.hpp"
#include "data/spill/spool.hpp"
#include "diag/diag.hpp"
#include "episodes/leaks/leaks.hpp"
#include "episodes/truth.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

/// The samples of an episode as the monitor sees them, by which episodes are told apart. Two files
/// of one recording are the same where the monitor could not tell them apart, whatever they are
/// stored in: a float16 is rounded, a sample that counts as missing is missing however that is
/// written, `hold` replaces it, a bool is true or false, and a zero has no sign.
class Seen {
public:
    /// The model outlives it.
    Seen(const check::Model& model, std::vector<Index> inputs);

    /// The next frame; `samples`: by index of the model's inputs.
    void add(const std::vector<plan::Sample>& samples);
    /// Of the frames so far.
    const data::EpisodeHash& hash() const { return hash_; }

private:
    struct Held {
        std::vector<float> values;
        std::uint32_t age = 0;  ///< missing samples since
    };
    void see(const check::Input& input, const plan::Sample& sample, Held& held,
             std::vector<float>& seen) const;

    const check::Model& model_;
    std::vector<Index> inputs_;
    std::vector<Held> held_;                ///< per input, the last present sample
    std::vector<std::vector<float>> seen_;  ///< per input, of this frame; empty: missing
    data::EpisodeHash hash_;
};

/// The frames of an episode, one after the other, from a file (Recording) or from memory.
class Frames {
public:
    virtual ~Frames() = default;

    /// The next frame; false at the end of the episode.
    virtual diag::Result<bool> next() = 0;
    /// Of this frame, by index of the model's inputs; those not wanted are not there.
    virtual const std::vector<plan::Sample>& samples() const = 0;
    /// Of this frame: one of the wanted predicates.
    virtual Label label(Index predicate) const = 0;
    /// How many there were so far.
    virtual std::uint64_t frames() const = 0;

protected:
    Frames() = default;
    Frames(const Frames&) = default;
    Frames(Frames&&) = default;
    Frames& operator=(const Frames&) = default;
    Frames& operator=(Frames&&) = default;
};

struct Wanted {
    const check::Model* model = nullptr;
    std::vector<Index> inputs;      ///< whose samples are wanted, of the model
    std::vector<Index> predicates;  ///< whose labels are wanted: named ones
    std::vector<Index> identity;    ///< inputs that the hash is made of, all of them wanted too
    const Leaks* leaks = nullptr;   ///< targets that no frame may be; null: all may
};

/// What an episode is told by once it has been read.
struct Recorded {
    std::string path;
    std::string hash;  ///< 16 hex digits
    data::EpisodeContent content;
    std::uint64_t frames = 0;
    std::optional<Leak> leak;    ///< the first one
    std::vector<NearLeak> near;  ///< which LeakEvidence judges
    bool is_unmarked = false;    ///< it does not say which encoder made its embeddings
};

template <class Archive>
void fields(Archive& archive, Recorded& recorded) {
    archive(recorded.path, recorded.hash, recorded.content, recorded.frames, recorded.leak,
            recorded.near, recorded.is_unmarked);
}

/// Its hash as a number, as files of thresholds and of fitted things have it.
inline std::uint64_t hash_of(const Recorded& recorded) {
    return data::hash_of_text(recorded.hash).value_or(0);  // which all of EpisodeHash are
}

/// Of all episodes of a call, in their order.
using Identities = data::Spool<Recorded>;

/// What was read of them for more.
template <class Episodes>
Identities recorded(const Episodes& episodes) {
    Identities result;
    for (const Recorded& episode : episodes) result.add(episode);
    return result;
}

/// The inputs that predicates with a calibrated threshold read, in order of their names: two
/// episodes with equal samples of these give equal scores, whatever else they hold. Without such a
/// predicate, the inputs of all.
std::vector<Index> identity_inputs(const check::Model& model);

/// The predicates whose truth is known: from the spec, or from an array in the episode of that
/// path. Failures do not name the path.
diag::Result<std::vector<Index>> labelled_in(const check::Model& model, const std::string& path,
                                             const data::NamesInFile& names);

/// Opens an episode with these channels.
using Opener =
    std::function<diag::Result<std::unique_ptr<data::Trace>>(const std::vector<data::Channel>&)>;

class Recording final : public Frames {
public:
    /// Failures: what opening the trace fails with; no_label where a predicate has neither a truth
    /// nor an array. They do not name the episode.
    static diag::Result<Recording> open(const Wanted& wanted, const std::string& path,
                                        const data::NamesInFile& names);
    static diag::Result<Recording> open(const Wanted& wanted, const Opener& open);

    diag::Result<bool> next() override;
    const std::vector<plan::Sample>& samples() const override { return samples_; }
    Label label(Index predicate) const override;
    /// Whether its labels come from an array of the episode.
    bool from_array(Index predicate) const { return sources_[predicate].from_array; }

    std::uint64_t frames() const override { return frames_; }
    /// Number of frames where the file tells it beforehand, else 0.
    std::uint64_t length() const { return trace_->length(); }
    /// Of the frames so far; hash and content over the inputs of `identity`.
    Recorded recorded() const {
        return {path_, seen_.hash().text(), seen_.hash().content(), frames_, leak_,
                near_, is_unmarked_};
    }

private:
    struct Source {
        bool from_array = false;
        std::size_t channel = 0;  ///< of the array
        Index formula = check::kNone;
    };

    explicit Recording(const Wanted& wanted)
        : model_(wanted.model), leaks_(wanted.leaks), seen_(*wanted.model, wanted.identity) {}

    diag::Result<bool> narrow();

    const check::Model* model_;
    const Leaks* leaks_;
    std::string path_;
    bool is_unmarked_ = false;
    Seen seen_;
    std::unique_ptr<data::Trace> trace_;
    std::vector<Index> channel_inputs_;  ///< per channel of an input, that input
    std::vector<bool> narrowed_;         ///< per such channel: its samples are wanted
    std::vector<Source> sources_;        ///< per predicate of the model
    std::unique_ptr<TruthEvaluator> truth_;
    data::Sample sample_;
    std::vector<plan::Sample> samples_;
    Frame frame_;
    std::uint64_t frames_ = 0;
    std::optional<Leak> leak_;
    std::vector<NearLeak> near_;
};

}  // namespace etlc::episodes
