// The shortest time in which a Dubins car reaches a set of states from every state without leaving
// the free ones. Takes: the goal states and the free places. Gives: seconds, interpolated between
// grid states. Keeps true: it is the semi-Lagrangian fixed point of T(s) = min over turn rates of h
// + T(s after h), the Hamilton-Jacobi reachability value, on a grid of positions and headings.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "world.hpp"

namespace demo {

class TimeField {
public:
    static constexpr double kNever = 30;  ///< s: means "cannot be reached"

    TimeField(const std::function<bool(const Car&)>& reached,
              const std::function<bool(Point)>& free);

    /// Returns seconds to the goal, at most kNever; the grid blurs the two beside forbidden places.
    double at(const Car& car) const;
    bool reachable(const Car& car) const { return at(car) < 0.5 * kNever; }

private:
    /// Trilinear interpolation as eight grid values, relative to the corner at heading 0 of a cell.
    struct Stencil {
        std::array<int, 8> offsets;
        std::array<float, 8> weights;
    };
    static Stencil stencil(const Car& car);
    float interpolate(const Stencil& stencil, std::size_t corner = 0) const;
    float relax(const std::vector<Stencil>& moves);

    std::vector<float> values_;  ///< s, [heading][y][x]
    /// Indices of the free states that are not the goal: the unknowns.
    std::vector<std::size_t> open_;
};

}  // namespace demo
