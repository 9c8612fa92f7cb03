// The camera above the world.
// Takes: the car's state. Gives: a grey image of the whole world, north up: white ground, the car a
// dark dot with a black triangle for its heading, antialiased.
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
