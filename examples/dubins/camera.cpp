#include "camera.hpp"

namespace demo {
namespace {

constexpr double kPixel = 2 * kHalfWidth / kImageSide;  // m
constexpr double kDotRadius = 0.09;                     // m
constexpr double kNoseAhead = 0.17;                     // m, tip of the triangle
constexpr double kBaseHalfWidth = 0.07;                 // m
constexpr double kDotGrey = 0.35;
constexpr int kSamples = 4;  // per pixel and axis

/// Returns the brightness at a point in the car's own frame: x ahead, y to the left.
double brightness(double x, double y) {
    const bool triangle = x >= 0 && std::abs(y) <= kBaseHalfWidth * (1 - x / kNoseAhead);
    if (triangle) return 0;
    return x * x + y * y <= kDotRadius * kDotRadius ? kDotGrey : 1;
}

double pixel(const Car& car, int row, int column) {
    const double c = std::cos(car.heading);
    const double s = std::sin(car.heading);
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
        for (int j = 0; j < kSamples; ++j) {
            const double x =
                -kHalfWidth + (column + (j + 0.5) / kSamples) * kPixel - car.position.x;
            const double y = kHalfWidth - (row + (i + 0.5) / kSamples) * kPixel - car.position.y;
            sum += brightness(c * x + s * y, c * y - s * x);
        }
    }
    return sum / (kSamples * kSamples);
}

}  // namespace

Image photograph(const Car& car) {
    Image image;
    image.fill(255);
    const int reach = static_cast<int>(kNoseAhead / kPixel) + 1;
    const int centre_row = static_cast<int>((kHalfWidth - car.position.y) / kPixel);
    const int centre_column = static_cast<int>((car.position.x + kHalfWidth) / kPixel);
    for (int row = std::max(0, centre_row - reach);
         row <= std::min(kImageSide - 1, centre_row + reach); ++row) {
        for (int column = std::max(0, centre_column - reach);
             column <= std::min(kImageSide - 1, centre_column + reach); ++column) {
            image[static_cast<std::size_t>(row * kImageSide + column)] =
                static_cast<std::uint8_t>(std::lround(255 * pixel(car, row, column)));
        }
    }
    return image;
}

}  // namespace demo
