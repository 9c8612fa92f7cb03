// The target sets of dubins.etl: camera images at a goal or at the obstacle.
// Takes: an encoder. Gives: one embedding per row, with the car at the centre and eight headings.
// Keeps true: the places do not come from any recorded drive.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "encoder.hpp"

namespace demo {

struct Region {
    std::string_view name;       ///< name of the file in targets/
    std::string_view predicate;  ///< name in the spec
    Disc disc;
};

/// In the order of the predicates in dubins.etl.
inline constexpr std::array<Region, 3> kRegions{{
    {"goal_a", "at_a", kGoalA},
    {"goal_b", "at_b", kGoalB},
    {"obstacle_c", "near_c", kObstacleC},
}};

inline constexpr int kTargetHeadings = 8;

inline std::vector<Embedding> target_set(const Encoder& encoder, Point centre) {
    std::vector<Embedding> rows;
    for (int i = 0; i < kTargetHeadings; ++i) {
        rows.push_back(encoder.encode(photograph({centre, 2 * kPi * i / kTargetHeadings})));
    }
    return rows;
}

}  // namespace demo
