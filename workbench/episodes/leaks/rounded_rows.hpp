// Finds rows of a target set that a frame may have been before rounding: projected in another
// order, stored as float16 or float32, or scaled to another length. Also counts how many frames
// near a row would be within rounding by chance. The bounds exceed what rounding does, so every row
// taken from a frame is found; whether it was taken, one frame cannot tell in few dimensions, and
// LeakEvidence (episodes/admission/admission.hpp) decides from all.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "execute/inputs.hpp"

namespace etlc::episodes {

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

}  // namespace etlc::episodes
