#include "episodes.hpp"

#include <cmath>

namespace manipulation {

namespace {

constexpr int kMostSteps = 600;

Rows column(const std::vector<float>& values) {
    return Eigen::Map<const Eigen::VectorXf>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
}

bool is_in(const Position& block, Place zone) {
    return std::abs(block[0] - zone[0]) <= kZone && std::abs(block[1] - zone[1]) <= kZone;
}

/// The specs define the same over the recorded state.
bool is_done(const Simulator& simulator, Task task, bool was_held) {
    const Position red = simulator.block(0);
    if (task == Task::pick_place) return was_held && is_in(red, kGoal) && red[2] < 0.6 * kBlock;
    const Position blue = simulator.block(1);
    if (task == Task::sorting) return is_in(red, kRedZone) && is_in(blue, kBlueZone);
    return is_in(red, kRegion) && std::abs(red[0] - blue[0]) <= kBlock / 2 &&
           std::abs(red[1] - blue[1]) <= kBlock / 2 && std::abs(red[2] - blue[2]) >= 0.9 * kBlock;
}

}  // namespace

Episode simulate(Simulator& simulator, Task task, bool shifted, Random& random) {
    const Plan plan = manipulation::plan(task, random);
    Gripper gripper(plan.way, random.uniform(0.35, 0.5));
    simulator.begin(plan.blocks, shifted ? shifted_look(random) : Look{}, Setpoint{});
    const std::vector<std::string> names = blocks(task);
    std::map<std::string, std::vector<float>> state;
    const auto note = [&](const std::string& name, const Position& at) {
        for (std::size_t i = 0; i < 3; ++i)
            state[name + "_" + "xyz"[i]].push_back(static_cast<float>(at[i]));
    };
    Episode episode;
    bool was_held = false;
    while (!gripper.is_done() && episode.images.size() < kMostSteps) {
        simulator.step(gripper.next());
        episode.images.push_back(simulator.image());
        was_held = was_held || simulator.is_held(0);
        note("tip", simulator.tip());
        for (std::size_t b = 0; b < names.size(); ++b) {
            note(names[b], simulator.block(b));
            state[names[b] + "_held"].push_back(simulator.is_held(b) ? 1 : 0);
        }
    }
    state["success"].assign(episode.images.size(),
                            is_done(simulator, task, was_held) ? 1.0F : 0.0F);
    for (const auto& [name, values] : state) episode.state[name] = column(values);
    return episode;
}

}  // namespace manipulation
