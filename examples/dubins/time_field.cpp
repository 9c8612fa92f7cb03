#include "time_field.hpp"

#include <algorithm>
#include <cmath>

namespace demo {
namespace {

constexpr double kCell = 0.06;  // m
constexpr int kCells =
    57;  // grid points along x and y: the world and a margin of three cells around it
constexpr double kOrigin = -kHalfWidth - 3 * kCell;
constexpr int kHeadings = 40;
constexpr double kHeadingStep = 2 * kPi / kHeadings;
constexpr double kStep = 0.12;     // s: two cells, less than the margin
constexpr float kSettled = 0.01F;  // s
constexpr int kMaxSweeps = 300;

constexpr double kRates[] = {-kMaxTurnRate, 0.0, kMaxTurnRate};

int index_of(int x, int y, int heading) {
    return (heading * kCells + y) * kCells + x;
}

}  // namespace

TimeField::TimeField(const std::function<bool(const Car&)>& reached,
                     const std::function<bool(Point)>& free)
    : values_(kCells * kCells * kHeadings, static_cast<float>(kNever)) {
    std::vector<Stencil> moves;  // per heading and turn rate, from the grid's origin
    for (int heading = 0; heading < kHeadings; ++heading) {
        for (const double rate : kRates) {
            const Car start{{kOrigin, kOrigin}, heading * kHeadingStep};
            moves.push_back(stencil(start.moved(rate, kStep)));
        }
        for (int y = 0; y < kCells; ++y) {
            for (int x = 0; x < kCells; ++x) {
                const Car car{{kOrigin + x * kCell, kOrigin + y * kCell}, heading * kHeadingStep};
                const auto index = static_cast<std::size_t>(index_of(x, y, heading));
                if (!inside_world(car.position) || !free(car.position)) continue;
                if (reached(car)) {
                    values_[index] = 0;
                } else {
                    open_.push_back(index);
                }
            }
        }
    }
    // In place and in alternating order (Gauss-Seidel), so that times spread far in one sweep.
    for (int sweep = 0; sweep < kMaxSweeps && relax(moves) > kSettled; ++sweep) {
        std::reverse(open_.begin(), open_.end());
    }
}

/// One sweep in place; returns the largest change, s.
float TimeField::relax(const std::vector<Stencil>& moves) {
    float change = 0;
    for (const std::size_t index : open_) {
        const std::size_t heading = index / (kCells * kCells);
        const std::size_t corner = index % (kCells * kCells);
        for (std::size_t rate = 0; rate < std::size(kRates); ++rate) {
            const float there = static_cast<float>(kStep) +
                                interpolate(moves[heading * std::size(kRates) + rate], corner);
            if (there >= values_[index]) continue;
            change = std::max(change, values_[index] - there);
            values_[index] = there;
        }
    }
    return change;
}

float TimeField::interpolate(const Stencil& stencil, std::size_t corner) const {
    float sum = 0;
    const float* from = values_.data() + corner;
    for (std::size_t i = 0; i < 8; ++i) sum += stencil.weights[i] * from[stencil.offsets[i]];
    return sum;
}

TimeField::Stencil TimeField::stencil(const Car& car) {
    const double across = (car.position.x - kOrigin) / kCell;
    const double up = (car.position.y - kOrigin) / kCell;
    const double turned = (car.heading < 0 ? car.heading + 2 * kPi : car.heading) / kHeadingStep;
    const double x = std::floor(across);
    const double y = std::floor(up);
    const double h = std::floor(turned);
    Stencil result{};
    for (int i = 0; i < 8; ++i) {
        const int dx = i & 1;
        const int dy = i >> 1 & 1;
        const int dh = i >> 2;
        const double weight = (dx ? across - x : 1 - across + x) * (dy ? up - y : 1 - up + y) *
                              (dh ? turned - h : 1 - turned + h);
        const auto slot = static_cast<std::size_t>(i);
        result.offsets[slot] = index_of(static_cast<int>(x) + dx, static_cast<int>(y) + dy,
                                        (static_cast<int>(h) + dh) % kHeadings);
        result.weights[slot] = static_cast<float>(weight);
    }
    return result;
}

double TimeField::at(const Car& car) const {
    return inside_world(car.position, -kCell) ? static_cast<double>(interpolate(stencil(car)))
                                              : kNever;
}

}  // namespace demo
