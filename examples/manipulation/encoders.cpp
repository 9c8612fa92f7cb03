#include "encoders.hpp"

#include <cmath>

#include "dubins/random.hpp"

namespace manipulation {

using demo::Random;

namespace {

constexpr Eigen::Index kFirst = 16;  // filters of each layer
constexpr Eigen::Index kSecond = 32;
constexpr Eigen::Index kPooled = 4;

/// Rows are pixels, columns are channels.
struct Map {
    Eigen::Index side;
    Eigen::MatrixXf values;
};

Map pixels(const Image& image) {
    Map map{kSide, Eigen::MatrixXf(kSide * kSide, 3)};
    for (Eigen::Index i = 0; i < map.values.size(); ++i)
        map.values(i / 3, i % 3) = static_cast<float>(image[static_cast<std::size_t>(i)]) / 255;
    return map;
}

/// The mean of each of side x side squares.
Map pooled(const Map& map, Eigen::Index side) {
    const Eigen::Index edge = map.side / side;
    Map result{side, Eigen::MatrixXf::Zero(side * side, map.values.cols())};
    for (Eigen::Index y = 0; y < map.side; ++y)
        for (Eigen::Index x = 0; x < map.side; ++x)
            result.values.row(y / edge * side + x / edge) += map.values.row(y * map.side + x);
    result.values /= static_cast<float>(edge * edge);
    return result;
}

/// Convolution and ReLU; outside the map is 0.
Map convolved(const Map& map, const Eigen::MatrixXf& filters, Eigen::Index width,
              Eigen::Index stride) {
    const Eigen::Index side = map.side / stride;
    const Eigen::Index channels = map.values.cols();
    Eigen::MatrixXf patches = Eigen::MatrixXf::Zero(side * side, filters.rows());
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
    return {side, (patches * filters).cwiseMax(0)};
}

/// Normal numbers by Box and Muller, each filter with mean 0 and norm 1.
Eigen::MatrixXf filters(Eigen::Index size, Eigen::Index count, Random& random) {
    Eigen::MatrixXf result(size, count);
    for (Eigen::Index f = 0; f < count; ++f) {
        for (Eigen::Index i = 0; i < size; ++i)
            result(i, f) = static_cast<float>(std::sqrt(-2 * std::log(random.uniform(1e-12, 1))) *
                                              std::cos(random.uniform(0, 2 * M_PI)));
        result.col(f).array() -= result.col(f).mean();
        result.col(f).normalize();
    }
    return result;
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
    first_ = filters(7 * 7 * 3, kFirst, random);
    second_ = filters(5 * 5 * kFirst, kSecond, random);
}

Eigen::VectorXf RandomConvolutions::encode(const Image& image) const {
    const Map first = convolved(pixels(image), first_, 7, 3);
    return flat(pooled(convolved(first, second_, 5, 2), kPooled));
}

}  // namespace manipulation
