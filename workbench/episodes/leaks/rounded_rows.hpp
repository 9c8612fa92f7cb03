// Rows of a target set that a frame may have been before it was rounded: projected in another
// order, stored as float16 or float32, scaled to another length.
// Takes: a point of the model, rows in its space, and a frame after the other. Gives: the row that
// the frame is within rounding of, and how many frames as near as this one's neighbourhood would be
// so by chance. Keeps true: the bounds are above what rounding does, so what was taken from a frame
// is found; whether it was taken, one frame cannot tell where the point has few dimensions, and
// LeakEvidence (episodes/admission/admission.hpp) decides from all.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "check/model/model.hpp"
#include "plan/evaluate/inputs.hpp"

namespace etlc::episodes {

using check::Index;

/// |v|, in double.
double length(const float* v, std::size_t n);

class RoundedRows {
public:
    /// `distance`: whose point or target these are, for its metric where it measures from `point`.
    /// `target`: its rows are in the space of `point`. The model outlives it.
    RoundedRows(const check::Model& model, Index distance, Index point, Index target);

    bool same_as(const RoundedRows& other) const {
        return point_ == other.point_ && target_ == other.target_ &&
               by_direction_ == other.by_direction_ && weights_ == other.weights_;
    }

    /// Frames about rows, and how many of them would be within rounding if they lay evenly there.
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
    /// `samples`: of this frame, by index of the model's inputs.
    Found find(const std::vector<plan::Sample>& samples) const;

private:
    /// A point of a frame, and how far rounding may have moved each element.
    struct Rounded {
        std::vector<float> elements;  ///< empty: unknown
        std::vector<double> error;
    };
    /// What is known of a row of a projection's matrix.
    struct RowNorms {
        double sum = 0;     ///< of |a|
        double length = 0;  ///< of a
        double offset = 0;  ///< the size of a (-m)
    };

    void add_moves(const check::Target& rows);
    /// False where the first elements of a sample tell that it is near no row, as they mostly do.
    bool may_be_near(const std::vector<float>& sample) const;
    /// `at`: what `from` is, through which the point goes.
    Rounded projected(Index point, Index from, const Rounded& at) const;
    Rounded taken(Index point, const std::vector<plan::Sample>& samples) const;
    std::vector<double> carried(const Rounded& inner, const check::Projection& map,
                                const std::vector<RowNorms>& norms, Index from) const;
    /// Adds what the weights make of no account.
    void weigh(Rounded& at) const;
    void add_row(const Rounded& at, double size, std::size_t largest, std::uint32_t row,
                 Found& found) const;

    const check::Model& model_;
    Index point_;
    Index target_;
    bool by_direction_ = false;
    std::vector<float> weights_;      ///< diagonal ones
    std::vector<double> per_length_;  ///< by direction: 1 / |row|
    std::vector<bool> is_half_;       ///< per row: its numbers are all of float16
    std::vector<double> moved_;       ///< per row that was projected, what it was rounded before
    std::vector<std::vector<RowNorms>> norms_;  ///< per projection of the model
};

}  // namespace etlc::episodes
