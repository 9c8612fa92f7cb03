// Nonconformity scores of the calibrated predicates and monitors. Distances come from the kernels
// that the monitor uses. Memory is that of one frame and of a number per labelled frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/replayer.hpp"
#include "data/spill/spill.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

/// The scores of an episode for one of the two errors: a miss, at positive frames, or a false
/// positive, at negative ones. Scores are negated where the threshold lies below them, so that
/// smaller ones are better.
struct SideScores {
    std::uint64_t frames = 0;     ///< frames at which the error can happen
    std::uint64_t lost = 0;       ///< those at which a missing sample counts as the error
    bool has_score = false;       ///< at least one of them was measured
    double worst_reach = 0;       ///< its greatest score in any build
    double worst_measured = 0;    ///< normal: its greatest score as measured here
    std::vector<double> reaches;  ///< class_conditional, risk: all scores

    void add(double reach, bool keep);
    /// Adds a step of a normal episode.
    void add_normal(double reach, double measured);
};

/// Scores of a predicate in one demonstration, or of a monitor that is calibrated as a whole in one
/// episode: its robustness is a predicate `rho >= shift`, true where its truth is satisfied.
struct Scores {
    struct Labelled {
        float score = 0;
        bool positive = false;
    };
    SideScores positives;            ///< of frames at which its truth holds
    SideScores negatives;            ///< of frames at which it does not
    std::uint64_t unlabelled = 0;    ///< frames at which its truth is open
    std::uint64_t unmeasured = 0;    ///< positive or negative frames whose distance is unknown
    bool from_array = false;         ///< labels come from an array of the episode
    std::vector<Labelled> labelled;  ///< all measured frames, negated for >= and >; of predicates

    SideScores& side(bool of_positives) { return of_positives ? positives : negatives; }
};

/// Whether a threshold is against misses, or against false positives.
bool is_against(const check::Threshold& threshold, bool misses);
/// Whether each error keeps all scores.
bool keeps_all(const check::Threshold& threshold);

struct Demonstration : episodes::Recorded {
    std::vector<Scores> scores;  ///< per calibrated predicate
    std::string track;           ///< of what the guarantees watch
    bool is_complete = true;     ///< it has all inputs that are watched
    bool is_divided = true;      ///< it has all labels that divide it into phases
};

template <class Archive>
void fields(Archive& archive, Scores::Labelled& frame) {
    archive(frame.score, frame.positive);
}

template <class Archive>
void fields(Archive& archive, SideScores& side) {
    archive(side.frames, side.lost, side.has_score, side.worst_reach, side.worst_measured,
            side.reaches);
}

template <class Archive>
void fields(Archive& archive, Scores& scores) {
    archive(scores.positives, scores.negatives, scores.unlabelled, scores.unmeasured,
            scores.from_array, scores.labelled);
}

template <class Archive>
void fields(Archive& archive, Demonstration& demonstration) {
    archive(static_cast<episodes::Recorded&>(demonstration), demonstration.scores,
            demonstration.track, demonstration.is_complete, demonstration.is_divided);
}

/// Scores of a predicate in all demonstrations, by their groups: those of a group count once, and a
/// demonstration without one is a group by itself. Memory is some bytes per episode and that of
/// data::Sorted, however many frames there are.
struct Evidence {
    /// The greatest score that any build may have measured.
    struct Reach {
        double reach = 0;
        std::uint32_t group = 0;
        std::uint32_t episode = 0;  ///< among those with a frame

        bool operator<(const Reach& other) const {
            return reach != other.reach ? reach < other.reach : group < other.group;
        }
    };

    struct Episode {
        std::uint32_t group = 0;
        std::uint64_t frames = 0;  ///< as in SideScores
        std::uint64_t lost = 0;
    };
    /// The scores of all episodes for one error.
    struct Side {
        std::uint64_t frames = 0;             ///< as in SideScores
        std::uint64_t without_score = 0;      ///< demonstrations
        std::vector<Reach> worst;             ///< one per group with a score
        std::vector<double> measured;         ///< likewise, as measured here; of normal episodes
        data::Sorted<Reach> reaches;          ///< class_conditional, risk: one per frame
        std::vector<Episode> episodes;        ///< those with a frame
        std::vector<std::uint32_t> places{};  ///< in `worst`, per group

        void add(const SideScores& scores, std::uint32_t group);
    };

    std::uint64_t demonstrations = 0;
    std::uint32_t groups = 0;
    std::uint64_t from_array = 0;  ///< demonstrations with an array of labels
    std::uint64_t unlabelled = 0;  ///< frames, as in Scores
    std::uint64_t unmeasured = 0;
    std::uint64_t failures = 0;  ///< episodes left out since their outcome is no success
    Side positives;
    Side negatives;
    episodes::FramesByScore labelled;  ///< all measured frames; `episode` is the group

    const Side& side(bool of_positives) const { return of_positives ? positives : negatives; }
    /// Adds the next demonstration. Numbers of groups begin with 0, without a gap.
    void add(const Scores& scores, std::uint32_t group);
};

/// Returns the scores of normal episodes as measured here, ascending; `above`: see fit.hpp.
std::vector<double> measured_scores(const Evidence& evidence, bool above);

/// Returns the predicates with a calibrated threshold, in the order of the model.
std::vector<Index> calibrated_predicates(const check::Model& model);

/// Whether every frame of a demonstration counts as positive, whatever its labels.
bool is_normal(const check::Threshold& threshold);
/// Whether the calibration does without the episode, since it is no demonstration.
bool leaves_out(const check::Threshold& threshold, const episodes::Recorded& episode);
/// Returns those predicates whose calibration reads labels.
std::vector<Index> with_labels(const check::Model& model, std::vector<Index> predicates);

}  // namespace etlc::calibrate
