// The camera above the world.
// Takes: the car's state. Gives: an antialiased grey image of the whole world, north up: white
// ground, the car as a dark dot with a black triangle for its heading.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "world.hpp"

namespace demo {

inline constexpr int kImageSide = 64;  ///< pixels

/// Row-major, the top row first; 0 is black, 255 white.
using Image = std::array<std::uint8_t, static_cast<std::size_t>(kImageSide) * kImageSide>;

Image photograph(const Car& car);

}  // namespace demo
