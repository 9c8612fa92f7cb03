// Nonconformity scores: what the calibrated predicates measured in one demonstration.
// Takes: a demonstration. Gives: per calibrated predicate its score and the counts that the report
// needs. Keeps true: distances come from the kernels that the monitor uses; memory is that of one
// frame and of a number for every labelled one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "episodes/replay.hpp"

namespace etlc::calibrate {

using check::Index;

/// One predicate in one demonstration. Scores are negated for >= and >, so that a smaller one
/// always is a better one.
struct Scores {
    struct Labelled {
        float score = 0;
        bool positive = false;
    };
    std::uint64_t positives = 0;   ///< frames at which its truth holds
    std::uint64_t negatives = 0;   ///< at which it does not
    std::uint64_t unlabelled = 0;  ///< at which a missing sample leaves that open
    std::uint64_t unmeasured = 0;  ///< positive or negative frames whose distance is unknown
    bool from_array = false;       ///< labels are those of an array of the episode

    bool has_score = false;          ///< some positive frame was measured
    double worst_reach = 0;          ///< the greatest score of one that any build may have measured
    std::vector<double> reaches;     ///< class_conditional: those of all positive frames
    std::vector<Labelled> labelled;  ///< all measured frames
};

struct Demonstration : episodes::Recorded {
    std::vector<Scores> scores;  ///< per calibrated predicate
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
    archive(static_cast<episodes::Recorded&>(demonstration), demonstration.scores);
}

/// Predicates of the model whose threshold is calibrated, in order.
std::vector<Index> calibrated_predicates(const check::Model& model);

/// Scores one demonstration after the other. Not shared between threads.
class Scorer {
public:
    Scorer(const check::Model& model, const episodes::Leaks& leaks, std::vector<Index> predicates,
           data::NamesInFile names);
    Scorer(const Scorer&) = delete;
    Scorer& operator=(const Scorer&) = delete;

    /// Failures do not name the path.
    diag::Result<Demonstration> score(const std::string& path);

private:
    void add(Index predicate, episodes::Label label, Scores& scores) const;

    const check::Model& model_;
    std::vector<Index> predicates_;
    plan::Plan plan_;
    episodes::Follower measured_;
    episodes::Wanted wanted_;
    data::NamesInFile names_;
};

}  // namespace etlc::calibrate
