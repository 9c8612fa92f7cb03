// manipulation_record TASK SEED EPISODES FOLDER [--shifted]: episodes of a task, for etlc.
// Gives: FOLDER/pixels/NNN.npz and FOLDER/conv/NNN.npz, the same episodes by two encoders: `z`, and
// the simulator's state: the tip of the gripper (tip_x, ...), each block (red_x, ..., red_held);
// `success`, at every step whether the task is done in the end.
// Keeps true: the same call gives the same episodes.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "encoders.hpp"
#include "npz.hpp"
#include "tasks.hpp"

namespace manipulation {
namespace {

constexpr int kMostSteps = 600;
constexpr std::uint64_t kFilters = 20;  // the seed of the convolutions, for all tasks

struct Episode {
    std::map<std::string, Rows> state;
    std::vector<Image> images;
};

Rows column(const std::vector<float>& values) {
    return Eigen::Map<const Eigen::VectorXf>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
}

bool is_in(const Position& block, Place zone) {
    return std::abs(block[0] - zone[0]) <= kZone && std::abs(block[1] - zone[1]) <= kZone;
}

/// The specs say the same of the recorded state.
bool is_done(const Simulator& simulator, Task task, bool was_held) {
    const Position red = simulator.block(0);
    if (task == Task::pick_place) return was_held && is_in(red, kGoal) && red[2] < 0.6 * kBlock;
    const Position blue = simulator.block(1);
    if (task == Task::sorting) return is_in(red, kRedZone) && is_in(blue, kBlueZone);
    return is_in(red, kRegion) && std::abs(red[0] - blue[0]) <= kBlock / 2 &&
           std::abs(red[1] - blue[1]) <= kBlock / 2 && std::abs(red[2] - blue[2]) >= 0.9 * kBlock;
}

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

template <class Encode>
void write(const std::string& path, Episode& episode, const Encode& encode) {
    const std::vector<Image>& images = episode.images;
    Rows z(static_cast<Eigen::Index>(images.size()), encode(images[0]).size());
    for (std::size_t t = 0; t < images.size(); ++t)
        z.row(static_cast<Eigen::Index>(t)) = encode(images[t]);
    episode.state["z"] = z;
    write_npz(path, episode.state);
}

void record(Task task, std::uint64_t seed, int episodes, const std::string& folder, bool shifted) {
    const RandomConvolutions convolutions(kFilters);
    for (const char* encoder : {"pixels", "conv"})
        std::filesystem::create_directories(folder + "/" + encoder);
    Simulator simulator(task);
    Random random(seed);
    for (int e = 0; e < episodes; ++e) {
        Episode episode = simulate(simulator, task, shifted, random);
        write(fmt::format("{}/pixels/{:03}.npz", folder, e), episode, encode_pixels);
        write(fmt::format("{}/conv/{:03}.npz", folder, e), episode,
              [&](const Image& image) { return convolutions.encode(image); });
    }
}

int run(const std::vector<std::string>& arguments) {
    const bool shifted = arguments.size() == 5 && arguments[4] == "--shifted";
    const auto* const task =
        arguments.empty() ? kTasks.end() : std::find(kTasks.begin(), kTasks.end(), arguments[0]);
    if (task == kTasks.end() || !(arguments.size() == 4 || shifted))
        throw std::runtime_error(
            "usage: manipulation_record sorting|stacking|pick_place SEED EPISODES FOLDER "
            "[--shifted]");
    record(static_cast<Task>(task - kTasks.begin()), std::stoull(arguments[1]),
           std::stoi(arguments[2]), arguments[3], shifted);
    return 0;
}

}  // namespace
}  // namespace manipulation

int main(int count, char** arguments) {
    try {
        return manipulation::run({arguments + 1, arguments + count});
    } catch (const std::exception& error) {
        fmt::print(stderr, "manipulation_record: {}\n", error.what());
        return 1;
    }
}
