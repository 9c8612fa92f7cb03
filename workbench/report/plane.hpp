// The plane in which a point of the spec moves most, for people to look at.
// Takes: some frames of the point. Gives: their mean and two directions of greatest variance.
// Keeps true: where all that is measured from the point are angles, frames count by their
// direction; the same frames give the same bits.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "data/recordings/open.hpp"
#include "diag/diag.hpp"

namespace etlc::report {

using check::Index;

struct Plane {
    Index point = 0;  ///< of the model
    bool by_direction = false;
    std::vector<double> mean;
    std::array<std::vector<double>, 2> axes;
    std::array<double, 2> explained{};  ///< parts of the variance, 0 to 1

    std::array<float, 2> operator()(const float* z) const;
};

/// Points of more than one number from which these predicates measure, in the order of the model.
std::vector<Index> points_to_draw(const check::Model& model, const std::vector<Index>& predicates);

/// Their planes, from frames taken evenly from at most kPlaneEpisodes episodes. A point with fewer
/// than two known frames has none. Failures do not name the path.
inline constexpr std::size_t kPlaneEpisodes = 24;
diag::Result<std::vector<Plane>> planes(const check::Model& model,
                                        const std::vector<Index>& predicates,
                                        const std::vector<std::string>& paths,
                                        const data::NamesInFile& names);

}  // namespace etlc::report
