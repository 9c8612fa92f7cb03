// Targets that are frames of the episodes which thresholds are calibrated, or monitors evaluated,
// on. Takes: the predicates that what is calibrated depends on, and an episode's samples, a frame
// after the other. Gives: the first frame that is a row of a set from which one of them measures,
// and those that may be one but for rounding. Keeps true: a sample is looked for as the monitor is
// given it, so a row counts as the frame that it becomes once it is rounded to the input's type;
// and where the distance measures, so a row counts as the frame that is projected to it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/leaks/rounded_rows.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

using check::Index;

/// A frame whose sample is a row of a target set.
struct Leak {
    Index predicate = 0;
    Index distance = 0;
    std::uint32_t row = 0;
    std::uint64_t frame = 0;
};

template <class Archive>
void fields(Archive& archive, Leak& leak) {
    archive(leak.predicate, leak.distance, leak.row, leak.frame);
}

/// What the frames of an episode say of one set that they are compared with within rounding.
struct NearLeak {
    std::optional<Leak> first;  ///< a frame that is as near as rounding explains
    RoundedRows::Around close;  ///< of all frames
    RoundedRows::Around wide;
};

template <class Archive>
void fields(Archive& archive, RoundedRows::Around& around) {
    archive(around.frames, around.chance);
}

template <class Archive>
void fields(Archive& archive, NearLeak& leak) {
    archive(leak.first, leak.close, leak.wide);
}

/// May be shared between threads; the model outlives it.
class Leaks {
public:
    Leaks(const check::Model& model, const std::vector<Index>& predicates);

    /// `samples`: of this frame, by index of the model's inputs.
    std::optional<Leak> find(const std::vector<plan::Sample>& samples, std::uint64_t frame) const;
    /// Adds what this frame says to `near`, which is empty before the first.
    void find_near(const std::vector<plan::Sample>& samples, std::uint64_t frame,
                   std::vector<NearLeak>& near) const;

private:
    /// A point and a set from which it is measured, by however many predicates.
    struct Watched {
        Index predicate = 0;  ///< the first that does
        Index distance = 0;
        bool by_direction = false;  ///< under cosine and angular a multiple of a row is the row
        /// First element of every row; by direction: of the row at length 1.
        std::vector<double> firsts;
        std::vector<double> lengths;  ///< by direction: |row|
    };

    struct WatchedNear {
        Index predicate = 0;
        Index distance = 0;
        RoundedRows rows;
    };

    void watch(Index predicate, Index distance);
    void watch_near(Index predicate, Index distance);
    std::optional<std::uint32_t> row_of(const Watched& watched,
                                        const std::vector<plan::Sample>& samples) const;

    const check::Model& model_;
    std::vector<Watched> watched_;
    std::vector<WatchedNear> watched_near_;
};

}  // namespace etlc::episodes
