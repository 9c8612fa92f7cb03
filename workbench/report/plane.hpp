// The plane of greatest variance of a point of the spec, from some of its frames. Frames count by
// their direction if only angles are measured from the point. The same frames give the same bits.
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
    Index point = 0;  ///< in the model
    bool by_direction = false;
    std::vector<double> mean;
    std::array<std::vector<double>, 2> axes;
    std::array<double, 2> explained{};  ///< shares of the variance, 0 to 1

    std::array<float, 2> operator()(const float* z) const;
};

/// Returns the points of several numbers from which the predicates measure, in the model's order.
std::vector<Index> points_to_draw(const check::Model& model, const std::vector<Index>& predicates);

/// Returns the planes of these points, from evenly chosen frames of at most kPlaneEpisodes
/// episodes. A point with fewer than two known frames has none. Failures do not name the path.
inline constexpr std::size_t kPlaneEpisodes = 24;
diag::Result<std::vector<Plane>> planes(const check::Model& model,
                                        const std::vector<Index>& predicates,
                                        const std::vector<std::string>& paths,
                                        const data::NamesInFile& names);

}  // namespace etlc::report
