// Nonconformity scores of the calibrated predicates. Distances come from the kernels that the
// monitor uses. Memory is that of one frame and of a number per labelled frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "calibrate/bounds.hpp"
#include "calibrate/replayer.hpp"
#include "data/spill/spill.hpp"
#include "episodes/ranking/auroc.hpp"
#include "episodes/recording.hpp"

namespace etlc::calibrate {

/// Scores of a predicate in one demonstration, negated for >= and > so that smaller ones are
/// better.
struct Scores {
    struct Labelled {
        float score = 0;
        bool positive = false;
    };
    std::uint64_t positives = 0;   ///< frames at which its truth holds
    std::uint64_t negatives = 0;   ///< frames at which it does not
    std::uint64_t unlabelled = 0;  ///< frames at which a missing sample leaves it open
    std::uint64_t unmeasured = 0;  ///< positive or negative frames whose distance is unknown
    bool from_array = false;       ///< labels come from an array of the episode

    bool has_score = false;          ///< at least one positive frame was measured
    double worst_reach = 0;          ///< its greatest score in any build
    std::vector<double> reaches;     ///< class_conditional: scores of all positive frames
    std::vector<Labelled> labelled;  ///< all measured frames
};

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
void fields(Archive& archive, Scores& scores) {
    archive(scores.positives, scores.negatives, scores.unlabelled, scores.unmeasured,
            scores.from_array, scores.has_score, scores.worst_reach, scores.reaches,
            scores.labelled);
}

template <class Archive>
void fields(Archive& archive, Demonstration& demonstration) {
    archive(static_cast<episodes::Recorded&>(demonstration), demonstration.scores,
            demonstration.track, demonstration.is_complete, demonstration.is_divided);
}

/// Scores of a predicate in all demonstrations, by their groups: those of a group count once, and a
/// demonstration without one is a group by itself. Memory is 24 bytes per group and that of
/// data::Sorted, however many frames there are.
struct Evidence {
    /// The greatest score that any build may have measured.
    struct Reach {
        double reach = 0;
        std::uint32_t group = 0;

        bool operator<(const Reach& other) const {
            return reach != other.reach ? reach < other.reach : group < other.group;
        }
    };

    std::uint64_t demonstrations = 0;
    std::uint32_t groups = 0;
    std::uint64_t without_score = 0;  ///< demonstrations
    std::uint64_t from_array = 0;     ///< demonstrations with an array of labels
    std::uint64_t positives = 0;      ///< frames, as in Scores
    std::uint64_t negatives = 0;
    std::uint64_t unlabelled = 0;
    std::uint64_t unmeasured = 0;
    std::vector<Reach> worst;          ///< one per group with a score
    data::Sorted<Reach> reaches;       ///< class_conditional: one per positive frame
    episodes::FramesByScore labelled;  ///< all measured frames; `episode` is the group

    /// Adds the next demonstration. Numbers of groups begin with 0, without a gap.
    void add(const Scores& scores, std::uint32_t group);

private:
    std::vector<std::uint32_t> place_;  ///< in `worst`, per group
};

/// Returns the predicates with a calibrated threshold, in the order of the model.
std::vector<Index> calibrated_predicates(const check::Model& model);

/// Scores one demonstration after the other, on one thread.
class Scorer {
public:
    /// Inputs that only the watched predicates and flags read may be absent, and labels that only
    /// divide episodes.
    Scorer(const check::Model& model, const episodes::Leaks& leaks, std::vector<Index> predicates,
           Watched watched, episodes::ReadOptions reading);
    Scorer(const Scorer&) = delete;
    Scorer& operator=(const Scorer&) = delete;

    /// Failures do not name the path.
    diag::Result<Demonstration> score(const std::string& path);

private:
    diag::Result<Demonstration> score(const std::string& path, const episodes::Wanted& wanted);
    void add(Index predicate, episodes::Label label, Scores& scores) const;

    const check::Model& model_;
    std::vector<Index> predicates_;
    Watched watched_;
    plan::Plan plan_;
    episodes::Follower measured_;
    PastIntervals pasts_;
    episodes::Wanted wanted_;
    episodes::Wanted divided_;  ///< the same with the labels that divide episodes
    episodes::ReadOptions reading_;
};

}  // namespace etlc::calibrate
