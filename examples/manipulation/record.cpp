// manipulation_record TASK SEED EPISODES FOLDER [--shifted] [--model FILE]: records episodes for
// etlc.
// Gives: FOLDER/ENCODER/NNN.npz, the same episodes for each encoder: pixels, conv, and trained if
// there is a model. Each has the embedding `z` and the simulator's state (episodes.hpp). Keeps
// true: the same call gives the same episodes.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "encoders.hpp"
#include "episodes.hpp"

namespace manipulation {
namespace {

constexpr std::uint64_t kFilters = 20;  // the seed of the convolutions, for all tasks

using Encode = std::function<Eigen::VectorXf(const Image&)>;

void write(const std::string& path, Episode& episode, const Encode& encode) {
    const std::vector<Image>& images = episode.images;
    Rows z(static_cast<Eigen::Index>(images.size()), encode(images[0]).size());
    for (std::size_t t = 0; t < images.size(); ++t)
        z.row(static_cast<Eigen::Index>(t)) = encode(images[t]);
    episode.state["z"] = z;
    write_npz(path, episode.state);
}

struct Order {
    Task task = Task::sorting;
    std::uint64_t seed = 0;
    int episodes = 0;
    std::string folder;
    bool shifted = false;
    std::string model;
};

std::map<std::string, Encode> encoders(const std::string& model) {
    std::map<std::string, Encode> result{{"pixels", encode_pixels}};
    result["conv"] = [random = RandomConvolutions(kFilters)](const Image& image) {
        return random.encode(image);
    };
    if (!model.empty())
        result["trained"] = [trained = TrainedConvolutions(model)](const Image& image) {
            return trained.encode(image);
        };
    return result;
}

void record(const Order& order) {
    Simulator simulator(order.task);
    const std::map<std::string, Encode> all = encoders(order.model);
    for (const auto& [name, encode] : all)
        std::filesystem::create_directories(order.folder + "/" + name);
    Random random(order.seed);
    for (int e = 0; e < order.episodes; ++e) {
        Episode episode = simulate(simulator, order.task, order.shifted, random);
        for (const auto& [name, encode] : all)
            write(fmt::format("{}/{}/{:03}.npz", order.folder, name, e), episode, encode);
    }
}

}  // namespace
}  // namespace manipulation

int main(int count, char** arguments) {
    manipulation::Order order;
    CLI::App app("Episodes of a task on a table, for etlc.", "manipulation_record");
    app.add_option("TASK", order.task)
        ->required()
        ->transform(CLI::Transformer(manipulation::kTasks));
    app.add_option("SEED", order.seed)->required();
    app.add_option("EPISODES", order.episodes)->required()->check(CLI::Range(1, 1000));
    app.add_option("FOLDER", order.folder)->required();
    app.add_flag("--shifted", order.shifted, "other light, a moved camera, a stranger");
    app.add_option("--model", order.model, "what manipulation_train made");
    CLI11_PARSE(app, count, arguments);
    try {
        manipulation::record(order);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "manipulation_record: {}\n", error.what());
        return 1;
    }
}
