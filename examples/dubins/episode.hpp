// Drives: seeded, the same on every run.
// Takes: an episode's number or a seed. Gives: the car's state at every step.
// Keeps true: every state lies inside the world; the drives mix success with every kind of failure.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "world.hpp"

namespace demo {

struct Episode {
    std::string_view plan;    ///< what the driver was told, "A then B"
    std::vector<Car> states;  ///< one a step
};

/// `count` tours of `steps` steps each, from the seed alone.
std::vector<Episode> drive_tours(std::uint64_t seed, int count, int steps);

/// States of cars that steer at random, spread evenly over the world: what the encoder is fitted
/// on.
std::vector<Car> wander(std::uint64_t seed, int count);

}  // namespace demo
