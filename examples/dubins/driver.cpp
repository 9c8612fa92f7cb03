#include "driver.hpp"

#include <algorithm>

namespace demo {
namespace {

constexpr double kWallMargin = 0.06;   // m, about a car's size
constexpr double kLookAhead = 0.1;     // s
constexpr double kWaypointSize = 0.1;  // m

bool is_free(const Tour& tour, Point p) {
    return inside_world(p, kWallMargin) &&
           std::none_of(tour.forbidden.begin(), tour.forbidden.end(),
                        [&](const Disc& disc) { return disc.contains(p); });
}

/// Returns whether the car could circle left or right for ever.
bool can_circle(const Tour& tour, const Car& car) {
    for (const double side : {1.0, -1.0}) {
        const Point centre{car.position.x - side * kTurnRadius * std::sin(car.heading),
                           car.position.y + side * kTurnRadius * std::cos(car.heading)};
        const auto crosses = [&](const Disc& disc) {
            return std::abs(distance(centre, disc.centre) - kTurnRadius) < disc.radius;
        };
        const bool clear = std::none_of(tour.forbidden.begin(), tour.forbidden.end(), crosses);
        if (clear && inside_world(centre, kTurnRadius + kWallMargin)) return true;
    }
    return false;
}

}  // namespace

Route::Route(Tour tour) : tour_(std::move(tour)) {
    const auto free = [this](Point p) { return is_free(tour_, p); };
    const TimeField circling([this](const Car& car) { return can_circle(tour_, car); }, free);
    for (const Point& waypoint : tour_.waypoints) {
        const auto arrived = [&](const Car& car) {
            return distance(car.position, waypoint) < kWaypointSize && circling.reachable(car);
        };
        legs_.emplace_back(arrived, free);
    }
    legs_.push_back(circling);
}

double Driver::turn_rate(const Car& car) {
    const std::vector<Point>& waypoints = route_.tour().waypoints;
    while (next_ < waypoints.size() &&
           distance(car.position, waypoints[next_]) < route_.tour().reach)
        ++next_;
    const TimeField& field = route_.leg(next_);

    double best = kMaxTurnRate;
    double best_time = 2 * TimeField::kNever;
    for (const double share : {1.0, -1.0, 0.5, -0.5, 0.0}) {
        const double rate = share * kMaxTurnRate;
        const double time = field.at(car.moved(rate, kLookAhead));
        if (time < best_time) {
            best_time = time;
            best = rate;
        }
    }
    return best;
}

}  // namespace demo
