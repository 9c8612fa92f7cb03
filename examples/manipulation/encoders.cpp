#include "encoders.hpp"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "dubins/random.hpp"
#include "npz.hpp"

namespace manipulation {

using demo::Random;

namespace {

constexpr Eigen::Index kPooled = 4;

/// Rows are pixels, columns are channels.
struct Map {
    Eigen::Index side;
    Rows values;
};

Map pixels(const Image& image) {
    Map map{kSide, Rows(kSide * kSide, 3)};
    for (Eigen::Index i = 0; i < map.values.size(); ++i)
        map.values(i / 3, i % 3) = static_cast<float>(image[static_cast<std::size_t>(i)]) / 255;
    return map;
}

/// Returns the means over side x side squares.
Map pooled(const Map& map, Eigen::Index side) {
    const Eigen::Index edge = map.side / side;
    Map result{side, Rows::Zero(side * side, map.values.cols())};
    for (Eigen::Index y = 0; y < map.side; ++y)
        for (Eigen::Index x = 0; x < map.side; ++x)
            result.values.row(y / edge * side + x / edge) += map.values.row(y * map.side + x);
    result.values /= static_cast<float>(edge * edge);
    return result;
}

Map convolved(const Map& map, const Convolution& layer) {
    const auto& [width, stride, filters, bias] = layer;
    const Eigen::Index side = map.side / stride;
    const Eigen::Index channels = map.values.cols();
    Rows patches = Rows::Zero(side * side, filters.rows());
    for (Eigen::Index y = 0; y < side; ++y)
        for (Eigen::Index x = 0; x < side; ++x)
            for (Eigen::Index dy = 0; dy < width; ++dy)
                for (Eigen::Index dx = 0; dx < width; ++dx) {
                    const Eigen::Index from_y = y * stride + dy - width / 2;
                    const Eigen::Index from_x = x * stride + dx - width / 2;
                    if (from_y < 0 || from_y >= map.side || from_x < 0 || from_x >= map.side)
                        continue;
                    patches.row(y * side + x).segment((dy * width + dx) * channels, channels) =
                        map.values.row(from_y * map.side + from_x);
                }
    return {side, ((patches * filters).rowwise() + bias).cwiseMax(0)};
}

/// Returns normal numbers by Box and Muller; each filter has mean 0 and norm 1.
Convolution random_layer(Eigen::Index width, Eigen::Index channels, Eigen::Index count,
                         Eigen::Index stride, Random& random) {
    Eigen::MatrixXf filters(width * width * channels, count);
    for (Eigen::Index f = 0; f < count; ++f) {
        for (Eigen::Index i = 0; i < filters.rows(); ++i)
            filters(i, f) = static_cast<float>(std::sqrt(-2 * std::log(random.uniform(1e-12, 1))) *
                                               std::cos(random.uniform(0, 2 * M_PI)));
        filters.col(f).array() -= filters.col(f).mean();
        filters.col(f).normalize();
    }
    return {width, stride, filters, Eigen::RowVectorXf::Zero(count)};
}

/// Reads the next numbers of the file.
Convolution read_layer(std::istream& file, Eigen::Index width, Eigen::Index channels,
                       Eigen::Index count, Eigen::Index stride) {
    Convolution layer{width, stride, Eigen::MatrixXf(width * width * channels, count),
                      Eigen::RowVectorXf(count)};
    const auto read = [&](float* values, Eigen::Index size) {
        file.read(reinterpret_cast<char*>(values),
                  static_cast<std::streamsize>(static_cast<std::size_t>(size) * sizeof(float)));
    };
    read(layer.filters.data(), layer.filters.size());
    read(layer.bias.data(), count);
    return layer;
}

Eigen::VectorXf flat(const Map& map) {
    return map.values.reshaped<Eigen::RowMajor>();
}

}  // namespace

Eigen::VectorXf encode_pixels(const Image& image) {
    return flat(pooled(pixels(image), 16));
}

RandomConvolutions::RandomConvolutions(std::uint64_t seed) {
    Random random(seed);
    layers_[0] = random_layer(7, 3, 16, 3, random);
    layers_[1] = random_layer(5, 16, 32, 2, random);
}

Eigen::VectorXf RandomConvolutions::encode(const Image& image) const {
    const Map first = convolved(pixels(image), layers_[0]);
    return flat(pooled(convolved(first, layers_[1]), kPooled));
}

TrainedConvolutions::TrainedConvolutions(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + " cannot be read");
    int channels = 3;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const LayerShape& shape = kTrainedLayers[i];
        layers_[i] = read_layer(file, shape.width, channels, shape.filters, shape.stride);
        channels = shape.filters;
    }
    last_ = read_layer(file, kTrainedSide, channels, kTrainedCode, 1);
    if (!file || file.peek() != std::istream::traits_type::eof())
        throw std::runtime_error(path + " is not a model by this version of manipulation_train");
}

Eigen::VectorXf TrainedConvolutions::encode(const Image& image) const {
    Map map = pixels(image);
    for (const Convolution& layer : layers_) map = convolved(map, layer);
    return flat(map).transpose() * last_.filters + last_.bias;
}

}  // namespace manipulation
