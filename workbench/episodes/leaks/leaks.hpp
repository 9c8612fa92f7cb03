// Finds targets that are frames of the episodes used to calibrate thresholds or to evaluate
// monitors: the first frame that is a row of a watched set, and those that may be one but for
// rounding. Samples are compared as the monitor gets them, so a row matches the frame that it
// becomes once rounded to the input's type, and in the space of the distance, so a row matches the
// frame that is projected to it. A row of points put together matches a frame that is a part of it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "episodes/leaks/rounded_rows.hpp"
#include "execute/inputs.hpp"

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

/// The evidence of an episode's frames about one set, within rounding.
struct NearLeak {
    std::optional<Leak> first;  ///< a frame as near as rounding explains
    RoundedRows::Around close;  ///< over all frames
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

/// Thread-safe; the model outlives it.
class Leaks {
public:
    Leaks(const check::Model& model, const std::vector<Index>& predicates);

    /// Returns the row that this frame equals. `samples`: by index of the model's inputs.
    std::optional<Leak> find(const std::vector<execute::Sample>& samples,
                             std::uint64_t frame) const;
    /// Adds the evidence of this frame to `near`, which is empty before the first.
    void find_near(const std::vector<execute::Sample>& samples, std::uint64_t frame,
                   std::vector<NearLeak>& near) const;

private:
    /// A point and a set that predicates measure it from.
    struct Watched {
        Index predicate = 0;  ///< the first such predicate
        Index distance = 0;
        bool by_direction = false;  ///< under cosine and angular a multiple of a row is the row
        /// The first element of every row; by direction, of the row at length 1.
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
    void watch_parts(Index predicate, Index distance);
    struct Measuring {
        Index predicate, distance;
    };
    void add_near(Measuring by, Index point, Index target, std::uint32_t offset = 0);
    std::optional<std::uint32_t> row_of(const Watched& watched,
                                        const std::vector<execute::Sample>& samples) const;

    const check::Model& model_;
    std::vector<Watched> watched_;
    std::vector<WatchedNear> watched_near_;
};

}  // namespace etlc::episodes
