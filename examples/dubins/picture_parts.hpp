// The parts of the picture, each drawn into its own area of the page.
#pragma once

#include <array>
#include <string_view>

#include "monitoring.hpp"
#include "svg.hpp"

namespace demo {

inline constexpr std::string_view kInk = "#1f2933";
inline constexpr std::string_view kGrey = "#7b8794";
inline constexpr std::string_view kRule = "#e4e7eb";
inline constexpr std::string_view kTruth = "#9aa5b1";
inline constexpr std::array<std::string_view, 3> kColours{"#2b6cb0", "#2f855a",
                                                          "#c0392b"};  ///< of A, B and C

struct Area {
    double left;
    double top;
    double width;
    double height;
};

void draw_traces(Svg& page, Area area, const Recording& recording);
void draw_map(Svg& page, Area area, const Recording& recording);
void draw_camera_strip(Svg& page, Area area, const Recording& recording);

/// Steps whose camera image is shown, and which the map numbers.
inline constexpr int kShots = 6;
inline std::size_t shot_step(int shot, std::size_t steps) {
    return static_cast<std::size_t>(shot) * (steps - 1) / (kShots - 1);
}

}  // namespace demo
