// The motions of the gripper in an episode: the three tasks, done well or not.
// Takes: a task and random numbers. Gives: the start of the blocks and the path of the gripper.
// Keeps true: the length of an episode does not reveal its success; a failed grasp goes through all
// motions.
#pragma once

#include <string_view>
#include <vector>

#include "dubins/random.hpp"
#include "simulator.hpp"

namespace manipulation {

using demo::Random;

enum class Failure {
    none,
    missed_grasp,  ///< the fingers close beside the block
    dropped,       ///< on the way
    wrong_place,   ///< beside its goal, or in the other block's zone
    forgotten,     ///< the gripper goes through its motions above the block
};

struct Waypoint {
    Position tip{};
    bool closed = false;
    int steps_there = 0;  ///< steps to wait there
};

struct Plan {
    std::vector<Place> blocks;  ///< start of the blocks
    std::vector<Waypoint> way;
    Failure failure = Failure::none;
};

Plan plan(Task task, Random& random);

/// Out of distribution: other light, another table, a moved camera, an unknown object.
Look shifted_look(Random& random);

/// Moves setpoints along a path at a bounded speed.
class Gripper {
public:
    Gripper(const std::vector<Waypoint>& way, double speed) : way_(way), speed_(speed) {}
    Setpoint next();
    bool is_done() const { return at_ == way_.size(); }

private:
    const std::vector<Waypoint>& way_;
    double speed_;  ///< m/s
    std::size_t at_ = 0;
    int waited_ = 0;
    Setpoint setpoint_;
};

}  // namespace manipulation
