// The world of the demo: a square floor with two goals and an obstacle, and a Dubins car on it.
// Units: metres, seconds, radians. The numbers are those of the paper's Dubins experiment.
#pragma once

#include <algorithm>
#include <cmath>

namespace demo {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kHalfWidth = 1.5;     ///< the world is [-1.5, 1.5] x [-1.5, 1.5]
inline constexpr double kSpeed = 1.0;         ///< m/s
inline constexpr double kMaxTurnRate = 1.25;  ///< rad/s
inline constexpr double kTurnRadius = kSpeed / kMaxTurnRate;
inline constexpr double kTimeStep = 0.05;  ///< s: 20 Hz, the `rate` of dubins.etl

struct Point {
    double x = 0;
    double y = 0;
};

inline double distance(Point a, Point b) {
    return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

struct Disc {
    Point centre;
    double radius;

    bool contains(Point p) const { return distance(p, centre) < radius; }
};

inline constexpr Disc kGoalA{{0.8, 0.8}, 0.25};
inline constexpr Disc kGoalB{{-0.8, 0.8}, 0.25};
inline constexpr Disc kObstacleC{{0.8, -0.8}, 0.5};

/// Position and heading; the speed is constant, and the turn rate steers.
struct Car {
    Point position;
    double heading = 0;

    /// Takes one step along the exact arc. A turn rate beyond the limit is clamped to it.
    Car moved(double turn_rate, double seconds) const {
        const double rate = std::clamp(turn_rate, -kMaxTurnRate, kMaxTurnRate);
        const double half_turn = 0.5 * rate * seconds;
        const double chord = std::abs(half_turn) < 1e-9
                                 ? kSpeed * seconds
                                 : kSpeed * seconds * std::sin(half_turn) / half_turn;
        const double along = heading + half_turn;
        const Point next{position.x + chord * std::cos(along),
                         position.y + chord * std::sin(along)};
        return {next, std::remainder(heading + 2 * half_turn, 2 * kPi)};
    }
};

inline bool inside_world(Point p, double margin = 0) {
    return std::abs(p.x) <= kHalfWidth - margin && std::abs(p.y) <= kHalfWidth - margin;
}

}  // namespace demo
