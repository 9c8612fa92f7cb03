// manipulation_train SEED EPISODES MODEL: trains the encoder for manipulation_record --model. It is
// a convolutional autoencoder that reconstructs the image from 128 numbers. It sees EPISODES of
// each task without a label. The lighting of its input is changed at random, that of the image to
// reconstruct is not, so the numbers should not depend on the light (a denoising autoencoder;
// Vincent, Larochelle, Bengio, Manzagol 2008).
#include <fmt/core.h>
#include <malloc.h>
#include <torch/torch.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <string>

#include "encoders.hpp"
#include "episodes.hpp"

namespace manipulation {
namespace {

constexpr int kEvery = 3;  // neighbouring images are almost equal
constexpr int kBatch = 64;

struct Order {
    std::uint64_t seed = 0;
    int episodes = 0;
    std::string model;
    int epochs = 12;
};

/// Images by channel, row, column; bytes.
torch::Tensor images(const Order& order) {
    std::vector<torch::Tensor> all;
    for (const auto& [name, task] : kTasks) {
        Simulator simulator(task);
        Random random(order.seed);
        for (int e = 0; e < order.episodes; ++e) {
            Episode episode = simulate(simulator, task, false, random);
            for (std::size_t t = 0; t < episode.images.size(); t += kEvery)
                all.push_back(
                    torch::from_blob(episode.images[t].data(), {kSide, kSide, 3}, torch::kUInt8)
                        .permute({2, 0, 1})
                        .clone());
        }
    }
    return torch::stack(all);
}

struct AutoencoderImpl : torch::nn::Module {
    AutoencoderImpl() {
        int channels = 3;
        for (const LayerShape& shape : kTrainedLayers) {
            encoder->push_back(
                torch::nn::Conv2d(torch::nn::Conv2dOptions(channels, shape.filters, shape.width)
                                      .stride(shape.stride)
                                      .padding(shape.width / 2)));
            encoder->push_back(torch::nn::ReLU());
            channels = shape.filters;
        }
        const int last = channels * kTrainedSide * kTrainedSide;
        code = register_module("code", torch::nn::Linear(last, kTrainedCode));
        decoder->push_back(torch::nn::Linear(kTrainedCode, last));
        decoder->push_back(torch::nn::Unflatten(
            torch::nn::UnflattenOptions(1, {channels, kTrainedSide, kTrainedSide})));
        for (auto shape = kTrainedLayers.rbegin(); shape != kTrainedLayers.rend(); ++shape) {
            const bool is_image = shape + 1 == kTrainedLayers.rend();
            decoder->push_back(torch::nn::ReLU());
            decoder->push_back(torch::nn::ConvTranspose2d(
                torch::nn::ConvTranspose2dOptions(shape->filters,
                                                  is_image ? 3 : (shape + 1)->filters, 4)
                    .stride(2)
                    .padding(1)));
        }
        register_module("encoder", encoder);
        register_module("decoder", decoder);
    }
    torch::Tensor forward(const torch::Tensor& batch) {
        return decoder->forward(code->forward(encoder->forward(batch).flatten(1)));
    }

    torch::nn::Sequential encoder;
    torch::nn::Linear code = nullptr;
    torch::nn::Sequential decoder;
};
TORCH_MODULE(Autoencoder);

/// Changes the light: each channel of each image times 0.7 to 1.3.
torch::Tensor lit(const torch::Tensor& batch) {
    return (batch * (0.7 + 0.6 * torch::rand({batch.size(0), 3, 1, 1}))).clamp(0, 1);
}

void train(Autoencoder& net, const torch::Tensor& bytes, int epochs) {
    const torch::Tensor mean = bytes.to(torch::kFloat).mean(0) / 255;
    torch::optim::Adam adam(net->parameters());
    for (int epoch = 0; epoch < epochs; ++epoch) {
        const double rate = 2e-3 * (epochs - epoch) / epochs;
        static_cast<torch::optim::AdamOptions&>(adam.param_groups()[0].options()).lr(rate);
        const torch::Tensor order = torch::randperm(bytes.size(0));
        double sum = 0;
        for (const torch::Tensor& some : order.split(kBatch)) {
            const torch::Tensor batch = bytes.index_select(0, some).to(torch::kFloat) / 255;
            // Moving parts are small: a pixel counts by its deviation from its mean.
            const torch::Tensor weight = 0.05 + (batch - mean).abs().amax(1, true);
            const torch::Tensor error = net->forward(lit(batch)) - (batch - mean);
            const torch::Tensor loss = (weight * error.square()).mean() / weight.mean();
            adam.zero_grad();
            loss.backward();
            adam.step();
            sum += loss.item<double>() * static_cast<double>(some.size(0));
        }
        fmt::print("epoch {:2}: weighted squared error {:.5f}\n", epoch + 1,
                   sum / static_cast<double>(bytes.size(0)));
        std::fflush(stdout);
    }
}

void write(std::ostream& file, const torch::Tensor& values) {
    const torch::Tensor flat = values.detach().contiguous();
    file.write(static_cast<const char*>(flat.data_ptr()),
               static_cast<std::streamsize>(flat.numel() * flat.element_size()));
}

/// Writes the format of TrainedConvolutions: one filter after the other, each by row, column,
/// channel.
void write(const Autoencoder& net, const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    for (std::size_t i = 0; i < kTrainedLayers.size(); ++i) {
        const auto layer = net->encoder->ptr<torch::nn::Conv2dImpl>(2 * i);
        write(file, layer->weight.permute({0, 2, 3, 1}));
        write(file, layer->bias);
    }
    const int channels = kTrainedLayers.back().filters;
    write(file, net->code->weight.view({kTrainedCode, channels, kTrainedSide, kTrainedSide})
                    .permute({0, 2, 3, 1}));
    write(file, net->code->bias);
    file.close();
    if (!file) throw std::runtime_error(path + " cannot be written");
}

void run(const Order& order) {
    // Each batch allocates and frees the same large blocks. Returning them to the system each time
    // took a third of the processor time.
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    torch::manual_seed(order.seed);
    const torch::Tensor bytes = images(order);
    fmt::print("{} images\n", bytes.size(0));
    Autoencoder net;
    train(net, bytes, order.epochs);
    write(net, order.model);
}

}  // namespace
}  // namespace manipulation

int main(int count, char** arguments) {
    manipulation::Order order;
    CLI::App app("An encoder for manipulation_record --model.", "manipulation_train");
    app.add_option("SEED", order.seed)->required();
    app.add_option("EPISODES", order.episodes, "of each task")
        ->required()
        ->check(CLI::Range(1, 1000));
    app.add_option("MODEL", order.model)->required();
    app.add_option("--epochs", order.epochs)->capture_default_str()->check(CLI::Range(1, 1000));
    CLI11_PARSE(app, count, arguments);
    try {
        manipulation::run(order);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "manipulation_train: {}\n", error.what());
        return 1;
    }
}
