// Episodes of a task, simulated from random numbers.
// Takes: a task, and whether it looks as usual. Gives: images, and the simulator's state at each
// step. Keeps true: the same random numbers give the same episode.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "npz.hpp"
#include "tasks.hpp"

namespace manipulation {

/// The state has one row per step: the tip of the gripper (tip_x, ...), each block (red_x, ...,
/// red_held), and `success`, which is at every step whether the task is done in the end.
struct Episode {
    std::map<std::string, Rows> state;
    std::vector<Image> images;
};

Episode simulate(Simulator& simulator, Task task, bool shifted, Random& random);

}  // namespace manipulation
