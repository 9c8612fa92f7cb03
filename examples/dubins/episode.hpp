// Drives from seeds, the same on every run.
// Takes: an episode's number or a seed. Gives: the car's state at every step. Keeps true: every
// state is inside the world; the drives include successes and every kind of failure.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "world.hpp"

namespace demo {

struct Episode {
    std::string_view plan;    ///< the driver's plan, "A then B"
    std::vector<Car> states;  ///< one per step
};

/// Returns `count` tours of `steps` steps each, from the seed.
std::vector<Episode> drive_tours(std::uint64_t seed, int count, int steps);

/// Returns states of cars that steer at random, evenly distributed over the world, for fitting the
/// encoder.
std::vector<Car> wander(std::uint64_t seed, int count);

}  // namespace demo
