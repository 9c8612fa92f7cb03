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
#include "execute/inputs.hpp"

namespace etlc::episodes {

// ---- rows that a frame equals up to rounding ----------------------------------------------------
// Finds rows of a target set that a frame may have been before rounding: projected in another
// order, stored as float16 or float32, or scaled to another length. Also counts how many frames
// near a row would be within rounding by chance. The bounds exceed what rounding does, so every row
// taken from a frame is found; whether it was taken, one frame cannot tell in few dimensions, and
// LeakEvidence (episodes/admission/admission.hpp) decides from all.

using check::Index;

/// Returns |v| in double.
double length(const float* v, std::size_t n);

class RoundedRows {
public:
    /// `distance`: one whose point or target these are; its metric counts where it measures from
    /// `point`. `target`: its rows are in the space of `point`; or of points put together, of which
    /// `point` is one, and `offset` its first element. The model outlives this.
    RoundedRows(const check::Model& model, Index distance, Index point, Index target,
                std::uint32_t offset = 0);

    bool same_as(const RoundedRows& other) const {
        return point_ == other.point_ && target_ == other.target_ && offset_ == other.offset_ &&
               by_direction_ == other.by_direction_ && weights_ == other.weights_;
    }

    /// Frames around rows, and how many would be within rounding if they were evenly spread there.
    struct Around {
        std::uint64_t frames = 0;
        double chance = 0;

        void add(const Around& more) {
            frames += more.frames;
            chance += more.chance;
        }
    };
    struct Found {
        std::optional<std::uint32_t> row;  ///< within rounding
        Around close;                      ///< within twice as much
        Around wide;                       ///< within many times as much
    };
    /// Compares a frame with all rows. `samples`: by index of the model's inputs.
    Found find(const std::vector<execute::Sample>& samples) const;

private:
    /// A point of a frame, and how far rounding may have moved each element.
    struct Rounded {
        std::vector<float> elements;  ///< empty: unknown
        std::vector<double> error;
    };
    /// Norms of a row of a projection's matrix.
    struct RowNorms {
        double sum = 0;     ///< sum of |a|
        double length = 0;  ///< length of a
        double offset = 0;  ///< magnitude of a (-m)
    };

    void add_moves(const check::Target& rows);
    std::uint32_t dimension() const { return model_.points[point_].dimension; }
    /// Returns the elements of a row that are compared with the point.
    const float* row_at(std::size_t row) const;
    /// Returns false where the first elements exclude all rows, as they mostly do.
    bool may_be_near(const std::vector<float>& sample) const;
    /// Projects `at`, the value of the point `from`, to `point`.
    Rounded projected(Index point, Index from, const Rounded& at) const;
    Rounded taken(Index point, const std::vector<execute::Sample>& samples) const;
    std::vector<double> carried(const Rounded& inner, const check::Projection& map,
                                const std::vector<RowNorms>& norms, Index from) const;
    /// Widens errors that the weights make negligible.
    void weigh(Rounded& at) const;
    void add_row(const Rounded& at, double size, std::size_t largest, std::uint32_t row,
                 Found& found) const;

    const check::Model& model_;
    Index point_;
    Index target_;
    std::uint32_t offset_;
    bool by_direction_ = false;
    std::vector<float> weights_;      ///< diagonal weights
    std::vector<double> per_length_;  ///< by direction: 1 / |row|
    std::vector<bool> is_half_;       ///< per row: all numbers are float16
    std::vector<double> moved_;       ///< per projected row, its rounding before the projection
    std::vector<std::vector<RowNorms>> norms_;  ///< per projection of the model
};

// ---- frames that equal a row --------------------------------------------------------------------

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
