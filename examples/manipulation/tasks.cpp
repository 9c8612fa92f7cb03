#include "tasks.hpp"

#include <cmath>

namespace manipulation {

namespace {

constexpr double kAbove = 0.17;  ///< height at which the gripper travels
constexpr double kGrasp = 0.02;  ///< height of the tip above the support of a block

double distance(Place a, Place b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
}

Place near(Place at, double most, Random& random) {
    return {at[0] + random.uniform(-most, most), at[1] + random.uniform(-most, most)};
}

/// Returns a place in the front half of the table, away from other blocks.
Place start(const std::vector<Place>& others, Random& random) {
    for (;;) {
        const Place at{random.uniform(-0.2, 0.2), random.uniform(-0.16, -0.02)};
        bool is_free = true;
        for (const Place& other : others) is_free = is_free && distance(at, other) > 0.12;
        if (is_free) return at;
    }
}

struct Move {
    Place from;
    Place to;
    double height = 0;  ///< height at which it is put down
    Failure failure = Failure::none;
};

/// Picks a block up and puts it down; a failure has the same number of motions.
void append(std::vector<Waypoint>& way, Move move, Random& random) {
    if (move.failure == Failure::missed_grasp) move.from[1] += random.uniform(0.05, 0.07);
    const double low = move.failure == Failure::forgotten ? kAbove - 0.06 : kGrasp;
    const auto at = [](Place p, double z) { return Position{p[0], p[1], z}; };
    const Place half{(move.from[0] + move.to[0]) / 2, (move.from[1] + move.to[1]) / 2};
    const bool carries = move.failure != Failure::dropped;
    way.push_back({at(move.from, kAbove), false, 0});
    way.push_back({at(move.from, low), false, 2});
    way.push_back({at(move.from, low), true, 6});
    way.push_back({at(move.from, kAbove), true, 0});
    way.push_back({at(half, kAbove), true, 0});
    way.push_back({at(move.to, kAbove + move.height), carries, 0});
    way.push_back({at(move.to, kGrasp + move.height + 0.002), carries, 2});
    way.push_back({at(move.to, kGrasp + move.height + 0.002), false, 5});
    way.push_back({at(move.to, kAbove + move.height), false, 0});
}

Failure draw_failure(Random& random) {
    if (random.uniform(0, 1) < 0.6) return Failure::none;
    return static_cast<Failure>(1 + random.bits() % 4);
}

void home(Plan& plan, Random& random) {
    plan.way.push_back(
        {{random.uniform(-0.2, 0.2), random.uniform(-0.15, 0.0), random.uniform(0.15, 0.2)},
         false,
         static_cast<int>(random.bits() % 30)});
}

/// Moves both blocks to their goals, in either order, with a failure in one of them.
void two_moves(Plan& plan, std::array<Move, 2> moves, std::size_t first, Random& random) {
    const std::size_t failing = random.bits() % 2;
    for (const std::size_t b : {first, 1 - first}) {
        if (b == failing) moves[b].failure = plan.failure;
        append(plan.way, moves[b], random);
    }
}

void sorting(Plan& plan, Random& random) {
    std::array<Place, 2> zones{kRedZone, kBlueZone};
    if (plan.failure == Failure::wrong_place) std::swap(zones[0], zones[1]);
    for (Place& zone : zones) zone = near(zone, 0.03, random);
    if (plan.failure == Failure::wrong_place && distance(zones[0], zones[1]) < 0.1)
        zones[0][1] -= 0.1;
    two_moves(plan, {Move{plan.blocks[0], zones[0]}, Move{plan.blocks[1], zones[1]}},
              random.bits() % 2, random);
}

void stacking(Plan& plan, Random& random) {
    const std::size_t base = random.bits() % 2;
    const Place region = near(kRegion, 0.03, random);
    Place top = near(region, 0.004, random);
    if (plan.failure == Failure::wrong_place) top[0] += random.bits() % 2 == 0 ? 0.035 : -0.035;
    std::array<Move, 2> moves{};
    moves[base] = {plan.blocks[base], region};
    moves[1 - base] = {plan.blocks[1 - base], top, kBlock};
    two_moves(plan, moves, base, random);
}

/// Moves the block over the wall to the goal, or back.
void pick_place(Plan& plan, Random& random) {
    const bool back = random.bits() % 3 == 0;
    const Place goal = near(kGoal, 0.03, random);
    const Place left{random.uniform(-0.22, -0.09), random.uniform(-0.08, 0.12)};
    plan.blocks = {back ? goal : left};
    Move move{plan.blocks[0], back ? left : goal, 0, plan.failure};
    if (plan.failure == Failure::wrong_place) move.to = near({-0.12, 0.02}, 0.04, random);
    append(plan.way, move, random);
}

}  // namespace

Plan plan(Task task, Random& random) {
    Plan plan;
    plan.failure = draw_failure(random);
    for (std::size_t b = 0; b < blocks(task).size(); ++b)
        plan.blocks.push_back(start(plan.blocks, random));
    switch (task) {
        case Task::sorting: sorting(plan, random); break;
        case Task::stacking: stacking(plan, random); break;
        case Task::pick_place: pick_place(plan, random); break;
    }
    home(plan, random);
    return plan;
}

Look shifted_look(Random& random) {
    Look look;
    const double light = random.uniform(0.85, 1.15);
    for (double& c : look.light) c *= light * random.uniform(0.95, 1.05);
    for (double& c : look.table) c *= random.uniform(0.93, 1.03);
    for (double& c : look.camera) c = random.uniform(-0.006, 0.006);
    look.has_stranger = random.bits() % 2 == 0;
    look.stranger = {random.uniform(-0.3, 0.3), random.uniform(0.24, 0.3)};
    return look;
}

Setpoint Gripper::next() {
    if (is_done()) return setpoint_;
    const Waypoint& goal = way_[at_];
    setpoint_.closed = goal.closed;
    double rest = 0;
    for (std::size_t i = 0; i < 3; ++i) rest = std::hypot(rest, goal.tip[i] - setpoint_.tip[i]);
    const double most = speed_ / kRate;
    if (rest > most) {
        for (std::size_t i = 0; i < 3; ++i)
            setpoint_.tip[i] += (goal.tip[i] - setpoint_.tip[i]) * most / rest;
        return setpoint_;
    }
    setpoint_.tip = goal.tip;
    if (waited_++ >= goal.steps_there) {
        ++at_;
        waited_ = 0;
    }
    return setpoint_;
}

}  // namespace manipulation
