// What all demonstrations say of one predicate.
// Takes: its scores in each. Gives: counts, and what thresholds are taken from. Keeps true: memory
// is that of 16 bytes a demonstration and of data::Sorted, however many frames there are.
#pragma once

#include <cstdint>
#include <vector>

#include "calibrate/scores.hpp"
#include "data/spill/sorted.hpp"
#include "episodes/ranking/auroc.hpp"

namespace etlc::calibrate {

struct Evidence {
    /// A score as far out as any build may have measured it.
    struct Reach {
        double reach = 0;
        std::uint32_t demonstration = 0;

        bool operator<(const Reach& other) const {
            return reach != other.reach ? reach < other.reach : demonstration < other.demonstration;
        }
    };

    std::uint64_t demonstrations = 0;
    std::uint64_t from_array = 0;  ///< demonstrations whose labels are those of an array of theirs
    std::uint64_t positives = 0;   ///< frames, as in Scores
    std::uint64_t negatives = 0;
    std::uint64_t unlabelled = 0;
    std::uint64_t unmeasured = 0;
    std::vector<Reach> worst;          ///< of each demonstration that has a score
    data::Sorted<Reach> reaches;       ///< class_conditional: of all positive frames
    episodes::FramesByScore labelled;  ///< all measured ones; `episode`: the demonstration

    /// Of the next demonstration.
    void add(const Scores& scores);
};

}  // namespace etlc::calibrate
